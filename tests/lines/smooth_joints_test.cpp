// Curves that continue each other in a corner of two become one.
#include "pcednet/lines/pieces/smooth_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pcednet::lines {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180.0, kLeastTurn = 30.0 * kOneDegree,
                 kWithinOfChord = 0.2;

Curve straight_curve(const Vec3& from, const Vec3& to) {
  return {.kind = CurveKind::kSegment, .points = {from, to}, .confidence = 0.5, .support = 10};
}

/// A segment of length 10 from there that turns so far from the x axis.
Curve turned_curve(const Vec3& from, double degrees) {
  const double t = degrees * kOneDegree;
  return straight_curve(from, from + 10.0 * Vec3(std::cos(t), std::sin(t), 0));
}

/// Of the circle of radius 10 about (0, 10, 0), from the origin on.
Curve arc_from_origin(double degrees) {
  const double t = degrees * kOneDegree;
  return {.kind = CurveKind::kArc,
          .points = {Vec3::Zero(), Vec3(10 * std::sin(t), 10 - 10 * std::cos(t), 0)},
          .centre = Vec3(0, 10, 0),
          .radius = 10.0};
}

const Curve kToOrigin = straight_curve({-20, 0, 0}, Vec3::Zero());

std::vector<Curve> smoothly_joined(std::vector<Curve> curves) {
  join_smooth_corners(curves, kLeastTurn, kWithinOfChord, 1.0);
  return curves;
}

TEST(SmoothJoints, CurvesThatContinueEachOtherBecomeOne) {
  Curve next = turned_curve(Vec3::Zero(), 10);
  next.confidence = 1.0;
  next.support = 30;
  std::swap(next.points.front(), next.points.back());
  const auto curves = smoothly_joined({kToOrigin, straight_curve({0, 50, 0}, {9, 50, 0}), next});
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].kind, CurveKind::kPolyline);
  ASSERT_EQ(curves[0].points.size(), 3u);
  EXPECT_EQ(curves[0].points[1], Vec3::Zero());
  EXPECT_EQ(curves[0].points[2], next.points[0]);
  EXPECT_EQ(curves[0].support, 40u);
  EXPECT_NEAR(curves[0].confidence, 0.875, 1e-12);
}

TEST(SmoothJoints, CurvesWithoutEdgePointsCountByTheirLength) {
  Curve first = straight_curve({-30, 0, 0}, Vec3::Zero()), next = turned_curve(Vec3::Zero(), 10);
  first.support = next.support = 0;
  next.confidence = 0.1;
  const auto curves = smoothly_joined({first, next});
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_NEAR(curves[0].confidence, 0.4, 1e-12);
}

TEST(SmoothJoints, AJoinOfExactCurvesIsExact) {
  Curve first = kToOrigin, next = turned_curve(Vec3::Zero(), 10);
  first.exact = true;
  EXPECT_FALSE(smoothly_joined({first, next})[0].exact);
  next.exact = true;
  EXPECT_TRUE(smoothly_joined({first, next})[0].exact);
}

TEST(SmoothJoints, SegmentsOfOneLineBecomeASegment) {
  const auto curves = smoothly_joined({kToOrigin, turned_curve(Vec3::Zero(), 0)});
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].kind, CurveKind::kSegment);
  EXPECT_NEAR(length_of(curves[0]), 30.0, 1e-12);
}

TEST(SmoothJoints, AStraightPolylineContinuesASegment) {
  Curve next = straight_curve(Vec3::Zero(), {30, 0, 0});
  next.kind = CurveKind::kPolyline;
  next.points = {Vec3::Zero(), {10, 0.1, 0}, {20, -0.1, 0}, {30, 0, 0}};
  const auto curves = smoothly_joined({kToOrigin, next});
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].kind, CurveKind::kSegment);
  EXPECT_NEAR(length_of(curves[0]), 50.0, 1e-12);
}

TEST(SmoothJoints, SegmentsThatHardlyTurnBecomeASegment) {
  const double bend = 0.15 / (20.0 * 10.0 / 30.0) / kOneDegree;  // 0.15 from the chord
  Curve first = kToOrigin, next = turned_curve(Vec3::Zero(), bend);
  EXPECT_EQ(smoothly_joined({first, next})[0].kind, CurveKind::kSegment);
  EXPECT_EQ(smoothly_joined({first, turned_curve(Vec3::Zero(), 2.0 * bend)})[0].kind,
            CurveKind::kPolyline);
  first.edge_class = next.edge_class = kBoundary;
  next.points[1] = turned_curve(Vec3::Zero(), 2.0 * bend).points[1];
  EXPECT_EQ(smoothly_joined({first, next})[0].kind, CurveKind::kSegment) << "less is known of it";
  first = kToOrigin, next = turned_curve(Vec3::Zero(), bend);
  first.exact = next.exact = true;
  EXPECT_EQ(smoothly_joined({first, next})[0].kind, CurveKind::kPolyline);
}

TEST(SmoothJoints, CurvesStayApartAtTurnsAtThirdEndsAndIfTheirClassesDiffer) {
  EXPECT_EQ(smoothly_joined({kToOrigin, turned_curve(Vec3::Zero(), 40)}).size(), 2u);
  EXPECT_EQ(
      smoothly_joined({kToOrigin, turned_curve(Vec3::Zero(), 10), turned_curve(Vec3::Zero(), 90)})
          .size(),
      3u);
  Curve other = turned_curve(Vec3::Zero(), 10);
  other.edge_class = kBoundary;
  EXPECT_EQ(smoothly_joined({kToOrigin, other}).size(), 2u);
}

TEST(SmoothJoints, CurvesOfTwoKindsThatTouchStayTwoAsDoPolylines) {
  EXPECT_EQ(smoothly_joined({kToOrigin, arc_from_origin(60)}).size(), 2u);
  EXPECT_EQ(smoothly_joined({arc_from_origin(60), kToOrigin}).size(), 2u);
  EXPECT_EQ(smoothly_joined({arc_from_origin(60), turned_curve({0, 0, 0}, 195)}).size(),
            2u);  // at 15 degrees
  EXPECT_EQ(smoothly_joined({arc_from_origin(60), turned_curve({0, 0, 0}, 205)}).size(), 1u);
  const Curve bent = {.points = {Vec3::Zero(), Vec3(10, 2, 0), Vec3(15, 9, 0)}};
  EXPECT_EQ(smoothly_joined({kToOrigin, bent}).size(), 2u);
}

TEST(SmoothJoints, ArcsThatContinueEachOtherAreFollowed) {
  Curve back = arc_from_origin(90);  // the same circle on the other side of the origin
  for (Vec3& point : back.points) point.x() = -point.x();
  std::swap(back.points.front(), back.points.back());
  const auto curves = smoothly_joined({arc_from_origin(90), back});
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_GT(curves[0].points.size(), 8u);
  for (const Vec3& point : curves[0].points) {
    EXPECT_NEAR((point - Vec3(0, 10, 0)).norm(), 10.0, 1e-9);
  }
}

TEST(SmoothJoints, ARingIsClosed) {
  std::vector<Curve> sides;
  for (int i = 0; i < 18; ++i) {
    const auto corner = [](int k) {
      const double t = 20.0 * kOneDegree * (k % 18);
      return Vec3(10 * std::cos(t), 10 * std::sin(t), 0);
    };
    sides.push_back(straight_curve(corner(i), corner(i + 1)));
  }
  const auto curves = smoothly_joined(sides);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_TRUE(curves[0].closed);
  EXPECT_EQ(curves[0].kind, CurveKind::kPolyline);
  EXPECT_EQ(curves[0].points.size(), 18u);
}

/// Segments from corner to corner of a regular polygon in a circle of that radius.
std::vector<Curve> polygon(int corners, double radius) {
  const auto corner = [&](int i) {
    const double t = 2.0 * std::numbers::pi * (i % corners) / corners;
    return Vec3(radius * std::cos(t), radius * std::sin(t), 3.0);
  };
  std::vector<Curve> sides;
  for (int i = 0; i < corners; ++i) sides.push_back(straight_curve(corner(i), corner(i + 1)));
  std::swap(sides[1].points[0], sides[1].points[1]);
  return sides;
}

std::vector<Curve> rounded(std::vector<Curve> curves) {
  close_round_loops(curves, 1.0, 1.5);
  return curves;
}

TEST(RoundLoops, ThreeSegmentsRoundASmallCircleAreIt) {
  const auto curves = rounded(polygon(3, 4.0));
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].kind, CurveKind::kCircle);
  EXPECT_TRUE(curves[0].closed);
  EXPECT_LT((curves[0].centre - Vec3(0, 0, 3)).norm(), 0.2);
  EXPECT_NEAR(curves[0].radius, 2.8, 0.4);  // between the circles in and about the triangle
  EXPECT_NEAR(std::abs(curves[0].axis.z()), 1.0, 1e-6);
  EXPECT_EQ(curves[0].support, 30u);
  EXPECT_NEAR(curves[0].confidence, 0.5, 1e-12);
}

TEST(RoundLoops, OthersStay) {
  EXPECT_EQ(rounded(polygon(4, 4.0)).size(), 4u) << "a square";
  EXPECT_EQ(rounded(polygon(3, 8.0)).size(), 3u) << "a triangle";
  auto curves = polygon(3, 4.0);
  curves.push_back(straight_curve(curves[0].points[0], {9, 9, 9}));
  EXPECT_EQ(rounded(curves).size(), 4u) << "another ends in a corner";
  curves = polygon(3, 4.0);
  curves[0].edge_class = kSmoothEdge;
  EXPECT_EQ(rounded(curves).size(), 3u) << "of two classes";
  curves = polygon(3, 4.0);
  curves.pop_back();
  EXPECT_EQ(rounded(curves).size(), 2u) << "open";
  curves = polygon(3, 4.0);
  for (Curve& curve : curves) curve.exact = true;
  EXPECT_EQ(rounded(curves).size(), 3u) << "of exact planes";
}

}  // namespace
}  // namespace pcednet::lines
