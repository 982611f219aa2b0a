#include "pcednet/lines/pieces/virtual_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lines/made_clouds.h"
#include "lines/made_pieces.h"
#include "pcednet/core/random_vectors.h"

namespace pcednet::lines {
namespace {

const Vec3 kY = Vec3::UnitY(), kZ = Vec3::UnitZ();

/// Along x, at (y, z), over 20 spacings.
Piece edge_at(double y, double z, const Vec3& side_a, const Vec3& side_b) {
  return straight({0, y, z}, {20, y, z}, side_a, side_b);
}

/// Two faces, along y and along z, and the two edges of the chamfer between them.
Piece lower_edge() {
  return edge_at(2, 0, kY, (kZ - kY).normalized());
}
Piece upper_edge() {
  return edge_at(0, 2, (kY - kZ).normalized(), kZ);
}

std::size_t left_of(std::vector<Piece> pieces) {
  drop_virtual_edges(pieces);
  return pieces.size();
}

TEST(VirtualEdges, AreDroppedWhereTheFacesWouldMeetAndOnTheChamfer) {
  for (const double at : {0.0, 0.6, 1.0}) {
    std::vector<Piece> pieces = {edge_at(at, at, kY, kZ), lower_edge(), upper_edge()};
    drop_virtual_edges(pieces);
    ASSERT_EQ(pieces.size(), 2u) << at;
    EXPECT_EQ(pieces[0].ends[0], Vec3(0, 2, 0));
    EXPECT_EQ(pieces[1].ends[0], Vec3(0, 0, 2));
  }
  EXPECT_EQ(left_of({upper_edge(), edge_at(0, 0, kZ, kY), lower_edge()}), 2u);
}

TEST(VirtualEdges, StayWithoutBothEdgesOfTheChamfer) {
  EXPECT_EQ(left_of({edge_at(0, 0, kY, kZ), lower_edge()}), 2u);
  EXPECT_EQ(left_of({edge_at(0, 0, kY, kZ), upper_edge()}), 2u);
  Piece half = upper_edge();
  half.nodes.resize(half.nodes.size() / 2);
  EXPECT_EQ(left_of({edge_at(0, 0, kY, kZ), lower_edge(), half}), 3u);
}

TEST(VirtualEdges, AreNoEdgesOfStepsOrOfThinPlates) {
  EXPECT_EQ(left_of({edge_at(0, 0, kY, -kZ), edge_at(2, 0, -kY, kZ), edge_at(2, 2, kY, -kZ)}), 3u);
  EXPECT_EQ(left_of({edge_at(0, 0, kY, -kZ), edge_at(2, 0, -kY, -kZ), edge_at(0, 2, kY, kZ)}), 3u);
  EXPECT_EQ(left_of({edge_at(0, 0, kY, kZ), edge_at(0.4, 0, kY, kZ), edge_at(0, 0.4, kY, kZ)}), 3u);
}

TEST(VirtualEdges, StayWhereExact) {
  Piece exact = edge_at(0, 0, kY, kZ);
  exact.exact = true;
  EXPECT_EQ(left_of({exact, lower_edge(), upper_edge()}), 3u);
}

/// The edge along x of two faces, with a chamfer as wide as this, in spacings.
Cloud chamfered(double width, double noise, std::uint64_t seed) {
  constexpr double kLength = 120.0, kFace = 20.0;
  Random random(seed);
  Cloud cloud{.spacing = 1.0};
  const double cut = width / std::numbers::sqrt2, whole = 2.0 * kFace + width;
  for (int i = 0; i < static_cast<int>(kLength * whole); ++i) {
    const double x = kLength * random.uniform(), at = whole * random.uniform() - kFace;
    const double on_chamfer = std::clamp(at, 0.0, width) / std::numbers::sqrt2;
    const Vec3 p(x, cut - on_chamfer + std::max(0.0, -at), on_chamfer + std::max(0.0, at - width));
    const Vec3 normal = at < 0.0 ? -kZ : at > width ? -kY : Vec3(-(kY + kZ).normalized());
    const bool edge = at > -1.0 && at < width + 1.0;
    cloud.add(p + noise * normal_vector(random), normal, edge);
  }
  return cloud;
}

TEST(VirtualEdges, AreNotDrawnOverChamfers) {
  for (const double width : {3.5, 4.0}) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const auto curves = lines_of(chamfered(width, 0.03, seed));
      double length = 0.0;
      for (const Curve& curve : curves) length += length_of(curve);
      EXPECT_EQ(curves.size(), 2u) << width << ", seed " << seed;
      EXPECT_NEAR(length, 240.0, 12.0) << width << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace pcednet::lines
