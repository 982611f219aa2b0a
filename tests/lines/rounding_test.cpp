#include "pcednet/lines/pieces/rounding.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "lines/made_clouds.h"
#include "lines/made_pieces.h"
#include "pcednet/core/random.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

constexpr double kOffArc = 0.2, kRounding = 5.0;

/// The straight piece with its nodes moved to the circle that touches the lines y = 0 and x = 0.
Piece chord_of_rounding() {
  Piece piece = straight({-4, 0.5, 0}, {-0.5, 4, 0});
  const Vec3 centre(-kRounding, kRounding, 0);
  for (ChainNode& node : piece.nodes) {
    node.at = centre + kRounding * (node.at - centre).normalized();
  }
  piece.fit = fit_segment(piece.nodes);
  return piece;
}

/// Along y = 0 and then x = 0, with this piece between.
std::vector<Piece> around(const Piece& between) {
  return {straight({-20, 0, 0}, {-5, 0, 0}), between, straight({0, 5, 0}, {0, 20, 0})};
}

OrderedPoints no_points() {
  return OrderedPoints(EdgePoints{});
}

std::size_t arcs_in(const std::vector<Piece>& pieces) {
  return static_cast<std::size_t>(std::count_if(
      pieces.begin(), pieces.end(), [](const Piece& p) { return p.fit.kind == CurveKind::kArc; }));
}

TEST(Rounding, AShortPieceBetweenTwoSegmentsBecomesTheArcThatTouchesBoth) {
  std::vector<Piece> pieces = around(chord_of_rounding());
  round_corners(pieces, no_points(), kOffArc);
  ASSERT_EQ(pieces[1].fit.kind, CurveKind::kArc);
  EXPECT_NEAR(pieces[1].fit.radius, kRounding, 0.3);
  EXPECT_NEAR((pieces[1].fit.point - Vec3(-kRounding, kRounding, 0)).norm(), 0.0, 0.4);
  EXPECT_EQ(pieces[1].ends[0], pieces[0].ends[1]);
  EXPECT_EQ(pieces[1].ends[1], pieces[2].ends[0]);
  EXPECT_NEAR(length_of(pieces[1]), 0.5 * std::numbers::pi * kRounding, 0.5);
}

/// Below the lines y = 0 and x = 0 and the arc between them.
std::vector<Vec3> wall_of_rounding() {
  Random random(3);
  const double arc = 0.5 * std::numbers::pi * kRounding, around = 30.0 + arc;
  std::vector<Vec3> wall;
  for (int i = 0; i < static_cast<int>(6.0 * around); ++i) {
    const double along = around * random.uniform(), z = -6.0 * random.uniform();
    const double angle = std::clamp((along - 15.0) / kRounding, 0.0, 0.5 * std::numbers::pi);
    const Vec3 centre(-kRounding, kRounding, z);
    const Vec3 on = centre + kRounding * Vec3(std::sin(angle), -std::cos(angle), 0);
    const double before = std::min(0.0, along - 15.0), after = std::max(0.0, along - 15.0 - arc);
    wall.push_back(on + Vec3(before, after, 0));
  }
  return wall;
}

TEST(Rounding, TheRadiusIsThatOfTheWallWhereNodesLieInsideOfIt) {
  std::vector<Piece> pieces = around(chord_of_rounding());
  for (ChainNode& node : pieces[1].nodes) node.at += Vec3(-0.3, 0.3, 0);
  std::vector<Piece> without = pieces;
  round_corners(without, no_points(), 2.0 * kOffArc);
  ASSERT_EQ(without[1].fit.kind, CurveKind::kArc);
  EXPECT_GT(without[1].fit.radius, kRounding + 0.3);
  const std::vector<Vec3> wall = wall_of_rounding(), normals(wall.size(), Vec3::UnitX());
  const std::vector<std::uint8_t> classes(wall.size(), kNonEdge);
  round_corners(pieces, OrderedPoints({wall, normals, classes}), 2.0 * kOffArc);
  ASSERT_EQ(pieces[1].fit.kind, CurveKind::kArc);
  EXPECT_NEAR(pieces[1].fit.radius, kRounding, 0.06);
}

TEST(Rounding, TheSenseOfThePiecesDoesNotMatter) {
  std::vector<Piece> pieces = around(chord_of_rounding());
  pieces[0] = straight({-5, 0, 0}, {-20, 0, 0});
  pieces[2] = straight({0, 20, 0}, {0, 5, 0});
  round_corners(pieces, no_points(), kOffArc);
  ASSERT_EQ(pieces[1].fit.kind, CurveKind::kArc);
  EXPECT_NEAR(pieces[1].fit.radius, kRounding, 0.3);
  EXPECT_EQ(pieces[1].ends[0], pieces[0].ends[0]);
  EXPECT_EQ(pieces[1].ends[1], pieces[2].ends[1]);
}

TEST(Rounding, AChamferStaysWhereThirdEdgesBegin) {
  std::vector<Piece> pieces = around(chord_of_rounding());
  pieces.push_back(straight({-5, 0, 0}, {-5, 0, -10}, Vec3::UnitX(), Vec3::UnitY()));
  round_corners(pieces, no_points(), kOffArc);
  EXPECT_EQ(arcs_in(pieces), 0u);
}

TEST(Rounding, AnEdgeAlongsideIsNoThirdEdge) {
  std::vector<Piece> pieces = around(chord_of_rounding());
  pieces.push_back(straight({-4, 0.5, -2}, {-0.5, 4, -2}));
  round_corners(pieces, no_points(), kOffArc);
  EXPECT_EQ(pieces[1].fit.kind, CurveKind::kArc);
}

TEST(Rounding, ALongChamferIsNearNoArc) {
  std::vector<Piece> pieces = {straight({-30, 0, 0}, {-12, 0, 0}),
                               straight({-12, 0, 0}, {0, 12, 0}), straight({0, 12, 0}, {0, 30, 0})};
  round_corners(pieces, no_points(), kOffArc);
  EXPECT_EQ(arcs_in(pieces), 0u);
}

TEST(Rounding, LinesThatMissEachOtherOrGoOnStraightStay) {
  std::vector<Piece> apart = around(chord_of_rounding());
  apart[2] = straight({0, 5, 1.2}, {0, 20, 1.2});
  round_corners(apart, no_points(), kOffArc);
  EXPECT_EQ(arcs_in(apart), 0u);
  std::vector<Piece> on = {straight({-20, 0, 0}, {-5, 0, 0}), straight({-4, 0, 0}, {0, 0.5, 0}),
                           straight({1, 0.7, 0}, {20, 5, 0})};
  round_corners(on, no_points(), kOffArc);
  EXPECT_EQ(arcs_in(on), 0u);
}

/// The top of a block of 40 by 40 with rounded vertical edges, and six of its walls.
Cloud rounded_block() {
  constexpr double kBlockSide = 40.0, kBlockDepth = 6.0, kWall = kBlockSide - 2.0 * kRounding;
  const double quarter = 0.5 * std::numbers::pi * kRounding, round = 4.0 * (kWall + quarter);
  Random random(5);
  Cloud cloud{.spacing = 1.0};
  const auto depth_of = [&](const Vec3& p) {  // from the outline inwards
    const Vec3 q = p.cwiseAbs() - Vec3::Constant(0.5 * kWall);
    if (q.x() > 0.0 && q.y() > 0.0) return kRounding - std::hypot(q.x(), q.y());
    return kRounding - std::max(q.x(), q.y());
  };
  for (int i = 0; i < static_cast<int>(kBlockSide * kBlockSide); ++i) {
    const double y = random.uniform() - 0.5, x = random.uniform() - 0.5;
    const Vec3 p(x * kBlockSide, y * kBlockSide, 0.0);
    const double inside = depth_of(p);
    if (inside > 0.0) cloud.add(p, Vec3::UnitZ(), inside < kNear);
  }
  for (int i = 0; i < static_cast<int>(round * kBlockDepth); ++i) {
    double along = std::fmod(random.uniform() * round, kWall + quarter);
    const double z = -kBlockDepth * random.uniform(), side = static_cast<double>(random.index(4));
    Vec3 place(0.5 * kBlockSide, along - 0.5 * kWall, z), normal = Vec3::UnitX();
    if (along > kWall) {
      const double t = (along - kWall) / kRounding;
      normal = {std::cos(t), std::sin(t), 0.0};
      place = Vec3(0.5 * kWall, 0.5 * kWall, z) + kRounding * normal;
    }
    const Eigen::AngleAxisd turn(side * 0.5 * std::numbers::pi, Vec3::UnitZ());
    cloud.add(turn * place, turn * normal, -z < kNear);
  }
  return cloud;
}

TEST(Rounding, TheOutlineOfARoundedBlockIsFourSegmentsAndFourArcs) {
  const Cloud block = rounded_block();
  const std::vector<Curve> curves = find_lines({block.positions, block.normals, block.classes}, {});
  int segments = 0, arcs = 0;
  for (const Curve& curve : curves) {
    segments += curve.kind == CurveKind::kSegment;
    arcs += curve.kind == CurveKind::kArc;
    EXPECT_TRUE(curve.kind != CurveKind::kArc || std::abs(curve.radius - kRounding) < 1.0);
  }
  EXPECT_EQ(segments, 4);
  EXPECT_EQ(arcs, 4);
  EXPECT_EQ(curves.size(), 8u);
}

}  // namespace
}  // namespace pcednet::lines
