#include "pcednet/lines/refine.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "lines/made_pieces.h"
#include "pcednet/core/random.h"

namespace pcednet::lines {
namespace {

/// About one point per unit of area, all of them edge points.
struct Points {
  std::vector<Vec3> positions = {}, normals = {};
  std::vector<std::uint8_t> classes = {};
  Random random = Random(4);

  void add(const Vec3& position, const Vec3& normal) {
    positions.push_back(position);
    normals.push_back(normal);
    classes.push_back(kSharpEdge);
  }
  Piece refined(const Piece& piece) const {
    std::vector<Piece> pieces = {piece};
    refine(pieces, OrderedPoints({positions, normals, classes}), {1.0, 0.0}, nullptr);
    return pieces.front();
  }
};

/// A slight arc through these places, between a surface towards `side_a` of the first and one
/// below.
Piece slight_arc(const std::vector<Vec3>& places, double radius) {
  Piece piece;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3 along = (places[std::min(i + 1, places.size() - 1)] - places[i > 0 ? i - 1 : 0]);
    piece.nodes.push_back({.at = places[i],
                           .along = along.normalized(),
                           .side_a = along.normalized().cross(Vec3::UnitZ()),
                           .side_b = -Vec3::UnitZ(),
                           .spacing = 1.0});
  }
  piece.fit = fit_arc(piece.nodes);
  EXPECT_EQ(piece.fit.kind, CurveKind::kArc);
  EXPECT_NEAR(piece.fit.radius, radius, 0.2 * radius);
  piece.ends = {nearest_on(piece.fit, places.front()), nearest_on(piece.fit, places.back())};
  return piece;
}

/// The piece as a segment.
Piece straightened(Piece piece) {
  piece.fit = fit_segment(piece.nodes);
  for (Vec3& end : piece.ends) end = nearest_on(piece.fit, end);
  return piece;
}

/// Two planes that meet in the x axis, and nodes along it on an arc with a radius of 12.5.
struct BetweenPlanes : Points {
  explicit BetweenPlanes(int count) {
    for (int i = 0; i < 800; ++i) {
      const double x = random.uniform() * 20.0 - 7.0, away = random.uniform() * 10.0;
      if (i % 2 == 0) add({x, -away, 0.0}, Vec3::UnitZ());
      if (i % 2 == 1) add({x, 0.0, -away}, Vec3::UnitY());
    }
    for (int i = 0; i < count; ++i) {
      places.emplace_back(i, 0.2 - 0.04 * std::pow(i - 0.5 * (count - 1), 2), 0.0);
    }
  }
  std::vector<Vec3> places = {};
};

TEST(Refine, MakesASegmentOfAnArcBetweenPlanes) {
  const BetweenPlanes cloud(7);
  const Piece piece = cloud.refined(slight_arc(cloud.places, 12.5));
  EXPECT_EQ(piece.fit.kind, CurveKind::kSegment);
  EXPECT_NEAR(std::abs(piece.fit.direction.x()), 1.0, 1e-9);
  EXPECT_NEAR(piece.ends[0].y(), 0.0, 1e-9);
}

TEST(Refine, LeavesASegmentBetweenPlanesThoughItsNodesBend) {
  const BetweenPlanes cloud(9);
  const Piece piece = cloud.refined(straightened(slight_arc(cloud.places, 12.5)));
  EXPECT_EQ(piece.fit.kind, CurveKind::kSegment);
  EXPECT_NEAR(piece.ends[0].y(), 0.0, 1e-9);
}

TEST(Refine, MakesASegmentOfABoundaryThatNoiseMayHaveBent) {
  const auto boundary = [](double rise) {  // 21 long
    std::vector<Vec3> places;
    for (int i = 0; i <= 20; ++i) places.emplace_back(i, rise * i * (20 - i) / 100.0, 0.0);
    Piece piece = slight_arc(places, 50.0 / rise);
    for (ChainNode& node : piece.nodes) node.boundary = 1.0;
    return Points().refined(piece).fit.kind;
  };
  EXPECT_EQ(boundary(0.6), CurveKind::kSegment);
  EXPECT_EQ(boundary(1.2), CurveKind::kArc);
}

constexpr double kRadius = 16.0;

/// The top and the wall of a cylinder, and nodes along its rim.
struct OnCylinder : Points {
  OnCylinder() {
    for (int i = 0; i < 1200; ++i) {
      const double angle = random.uniform() * 1.6;
      const Vec3 out(std::sin(angle), std::cos(angle), 0.0);
      const double away = random.uniform() * 8.0;
      if (i % 2 == 0) add((kRadius - away) * out, Vec3::UnitZ());
      if (i % 2 == 1) add(kRadius * out - away * Vec3::UnitZ(), out);
    }
    for (int i = 0; i <= 8; ++i) {
      const double angle = 0.5 + i / kRadius;
      places.emplace_back(kRadius * std::sin(angle), kRadius * std::cos(angle), 0.0);
    }
  }
  std::vector<Vec3> places = {};
};

TEST(Refine, LeavesAnArcWhereASurfaceIsRound) {
  const OnCylinder cloud;
  const Piece piece = cloud.refined(slight_arc(cloud.places, kRadius));
  EXPECT_EQ(piece.fit.kind, CurveKind::kArc);
  EXPECT_NEAR(piece.fit.radius, kRadius, 1e-6);
}

TEST(Refine, MakesAnArcOfASegmentWhereASurfaceIsRound) {
  const OnCylinder cloud;
  const Piece piece = cloud.refined(straightened(slight_arc(cloud.places, kRadius)));
  EXPECT_EQ(piece.fit.kind, CurveKind::kArc);
  EXPECT_NEAR(piece.fit.radius, kRadius, 1e-6);
}

}  // namespace
}  // namespace pcednet::lines
