#include "pcednet/lines/pieces/regularise.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "lines/made_pieces.h"
#include "pcednet/lines/pieces/finish.h"

namespace pcednet::lines {
namespace {

Vec3 direction_of(const Curve& curve) {
  return (curve.points.back() - curve.points.front()).normalized();
}

/// The sine of the angle between two segments, or its difference from 1.
double off_parallel(const Curve& a, const Curve& b) {
  return direction_of(a).cross(direction_of(b)).norm();
}
double off_right_angle(const Curve& a, const Curve& b) {
  return std::abs(direction_of(a).dot(direction_of(b)));
}

TEST(Regularise, MakesATwistedQuadrilateralARectangle) {
  std::vector<Piece> pieces = {
      straight({0, 0, 0}, {40, 0.5, 0}), straight({40, 0.5, 0}, {39.5, 20, 0.4}),
      straight({39.5, 20, 0.4}, {0.6, 20.4, 0}), straight({0.6, 20.4, 0}, {0, 0, 0})};
  regularise(pieces);
  const auto curves = finish(pieces, {.tolerance = 0.3, .noise = 0.0});
  ASSERT_EQ(curves.size(), 4u);
  EXPECT_LT(off_parallel(curves[0], curves[2]), 1e-9);
  EXPECT_LT(off_parallel(curves[1], curves[3]), 1e-9);
  EXPECT_LT(off_right_angle(curves[0], curves[1]), 1e-9);
  EXPECT_LT(off_right_angle(curves[2], curves[3]), 1e-9);
  EXPECT_EQ(curves[0].points.back(), curves[1].points.front()) << "corners stay shared";
  EXPECT_LT((curves[0].points.front() - Vec3(0, 0, 0)).norm(), 1.0);
}

TEST(Regularise, MakesASegmentOrthogonalToTwoThatAreNot) {
  const Vec3 slanted = Vec3(std::cos(1.4), std::sin(1.4), 0);  // 80 degrees from x
  std::vector<Piece> pieces = {straight({0, 0, 0}, {60, 0, 0}), straight({0, 0, 0}, 40.0 * slanted),
                               straight({0, 0, 0}, {0.6, -0.5, 20})};
  regularise(pieces);
  for (const int longer : {0, 1}) {
    EXPECT_NEAR(pieces[2].fit.direction.dot(pieces[static_cast<std::size_t>(longer)].fit.direction),
                0.0, 1e-12);
  }
  EXPECT_TRUE(pieces[0].regular && pieces[1].regular && pieces[2].regular);
}

TEST(Regularise, LeavesATaperThatItsLengthProves) {
  // 2.9 degrees move the ends of 60 spacings by 1.5, those of 20 by .5.
  for (const double length : {60.0, 20.0}) {
    const Vec3 end(length, 20.0 + 0.05 * length, 0);
    std::vector<Piece> pieces = {straight({0, 0, 0}, {70, 0, 0}), straight({0, 20, 0}, end)};
    regularise(pieces);
    EXPECT_EQ(pieces[1].regular, length < 30.0);
    EXPECT_EQ((pieces[1].ends[1] - end).norm() < 1e-9, length > 30.0);
  }
}

TEST(Regularise, LeavesOthersAsTheyAre) {
  std::vector<Piece> pieces = {straight({0, 0, 0}, {60, 0, 0}), straight({0, 0, 0}, {30, 20, 0})};
  const Vec3 before = pieces[1].fit.direction;
  regularise(pieces);
  EXPECT_EQ(pieces[1].fit.direction, before);
  EXPECT_FALSE(pieces[0].regular || pieces[1].regular);
}

TEST(Regularise, DoesNotCollapseWhatCannotBeRegular) {
  // A triangle on whose sides directions are forced that no triangle has.
  std::vector<Piece> pieces = {straight({0, 0, 0}, {30, 0, 0}), straight({30, 0, 0}, {15, 20, 0}),
                               straight({15, 20, 0}, {0, 0, 0})};
  for (Piece& piece : pieces) {
    piece.regular = true;
    piece.fit.direction = Vec3::UnitX();
  }
  Corners corners;
  corners.places = {{0, 0, 0}, {30, 0, 0}, {15, 20, 0}};
  corners.of_ends = {{0, 1}, {1, 2}, {2, 0}};
  const auto before = corners.places;
  hold_directions(pieces, corners);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT((corners.places[i] - before[i]).norm(), 1e-6) << i;
  }
}

TEST(Finish, MakesACircleOfAnArcWhoseEndsShareACorner) {
  const Piece nearly = round_about_z(10.0, 0.0, 0.0, 6.1);
  const Piece touching = straight(nearly.ends[0], nearly.ends[0] + Vec3(20, 0, 0));
  const auto curves = finish({nearly, touching}, {.tolerance = 0.3, .noise = 0.0});
  const auto circle = std::find_if(curves.begin(), curves.end(), [](const Curve& curve) {
    return curve.kind != CurveKind::kSegment;
  });
  ASSERT_NE(circle, curves.end());
  EXPECT_GT(length_of(*circle), 55.0);
}

TEST(Finish, GivesACurveWithoutEdgePointsTheConfidenceOfItsCreases) {
  Piece piece = straight({0, 0, 0}, {20, 0, 0});
  for (ChainNode& node : piece.nodes) node.edge_points = 0.0, node.probability = 0.6;
  EXPECT_NEAR(curve_of(piece, {.tolerance = 0.3, .noise = 0.0}).confidence, 0.6, 1e-12);
}

}  // namespace
}  // namespace pcednet::lines
