#include "pcednet/lines/pieces/refine.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
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
  Piece refined(const Piece& piece, double noise = 0.0) const {
    std::vector<Piece> pieces = {piece};
    refine(pieces, OrderedPoints({positions, normals, classes}), {1.0, noise}, nullptr);
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

TEST(Refine, MakesASegmentOfAnArcThoughNoiseTurnedASideOfANode) {
  const BetweenPlanes cloud(11);
  std::vector<Vec3> places;
  for (int i = 0; i < 11; ++i) places.emplace_back(i, 0.2 - 0.02 * std::pow(i - 5, 2), 0.0);
  Piece arc = slight_arc(places, 25.0);
  arc.nodes[3].side_b = Vec3(0.0, 0.6, -0.8);
  const Piece piece = cloud.refined(arc);
  EXPECT_EQ(piece.fit.kind, CurveKind::kSegment);
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

TEST(Refine, MakesASegmentOfAnArcThatMuchNoiseMayHaveBent) {
  const auto kind_of = [](double rise, double noise) {  // 21 long
    std::vector<Vec3> places;
    for (int i = 0; i <= 20; ++i) places.emplace_back(i, rise * i * (20 - i) / 100.0, 0.0);
    return Points().refined(slight_arc(places, 50.0 / rise), noise).fit.kind;
  };
  EXPECT_EQ(kind_of(0.6, 0.5), CurveKind::kSegment);
  EXPECT_EQ(kind_of(1.2, 0.5), CurveKind::kArc);
  EXPECT_EQ(kind_of(0.6, 0.1), CurveKind::kArc);
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

/// A plane with a hole of radius 12, and the hole's wall, each point off its surface by `noise`.
Points plane_with_hole(double noise) {
  Points cloud;
  Random& random = cloud.random;
  for (int i = 0; i < 1600; ++i) {
    const double x = random.uniform(-20.0, 20.0), y = random.uniform(-20.0, 20.0);
    const Vec3 place(x, y, 0.0);
    if (place.norm() > 12.0)
      cloud.add(place + noise * random.normal() * Vec3::UnitZ(), Vec3::UnitZ());
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    if (i % 2 == 0) {
      const double deep = 10.0 * random.uniform();
      cloud.add((12.0 + noise * random.normal()) * out - deep * Vec3::UnitZ(), -out);
    }
  }
  return cloud;
}

/// The hole's edge, tilted by 4 degrees and off by half a spacing.
Piece tilted_edge() {
  Piece piece = round_about_z(12.0, 0.0, 0.0, 2.0 * std::numbers::pi);
  piece.closed = true;
  piece.fit.direction = Vec3(std::sin(0.07), 0.0, std::cos(0.07));
  piece.fit.point = Vec3(0.3, -0.4, 0.0);
  for (ChainNode& node : piece.nodes) {
    node.side_a = Vec3(node.at.x(), node.at.y(), 0.0).normalized();
    node.side_b = -Vec3::UnitZ();
    node.spacing = 1.0;
  }
  return piece;
}

TEST(Refine, PutsATiltedCircleIntoThePlaneThatItEnds) {
  for (const double noise : {0.0, 0.3}) {
    const Fit fit = plane_with_hole(noise).refined(tilted_edge(), noise).fit;
    EXPECT_LT(std::hypot(fit.direction.x(), fit.direction.y()), noise > 0.0 ? 0.01 : 1e-3) << noise;
    EXPECT_LT(fit.point.norm(), noise > 0.0 ? 0.1 : 1e-3) << noise;
    EXPECT_NEAR(fit.radius, 12.0, noise > 0.0 ? 0.1 : 1e-3) << noise;
  }
}

TEST(Refine, PlacesABluntEdgeAmongItsPoints) {
  Points cloud;
  for (int i = 0; i < 1600; ++i) {  // planes that end 2 spacings before they would meet
    const double x = 40.0 * cloud.random.uniform() - 10.0,
                 away = 2.0 + 8.0 * cloud.random.uniform();
    const double between = 2.0 * cloud.random.uniform();
    cloud.add({x, -away, 0.0}, Vec3::UnitZ());
    cloud.add({x, 0.0, -away}, Vec3::UnitY());
    if (i % 3 == 0) cloud.add({x, between - 2.0, -between}, Vec3(0.0, 1.0, 1.0).normalized());
  }
  Piece piece = straight_along_x(0.0, 20.0);
  for (ChainNode& node : piece.nodes) {
    node.at -= Vec3(0.0, 0.8, 0.8);
    node.side_a = -Vec3::UnitY(), node.side_b = -Vec3::UnitZ(), node.spacing = 1.0;
  }
  piece = straightened(piece);
  const Vec3 at = cloud.refined(piece).fit.point;
  EXPECT_NEAR(at.y(), -1.0, 0.25);
  EXPECT_NEAR(at.z(), -1.0, 0.25);
}

}  // namespace
}  // namespace pcednet::lines
