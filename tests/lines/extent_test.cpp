#include "pcednet/lines/pieces/extent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lines/made_pieces.h"
#include "pcednet/core/random.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {
namespace {

/// Random points, three per unit of area, on two faces that meet in the x axis: y > 0 from `from`
/// to `to_a`, z > 0 from `from` to `to_b`.
std::vector<Vec3> two_faces(double from, double to_a, double to_b) {
  constexpr double kWidth = 6.0;
  Random random(1);
  std::vector<Vec3> positions;
  for (const auto& [to, across] : {std::pair(to_a, Vec3::UnitY()), {to_b, Vec3::UnitZ()}}) {
    for (int i = 0; i < static_cast<int>(3.0 * kWidth * (to - from)); ++i) {
      const double x = random.uniform(from, to), away = random.uniform(0.0, kWidth);
      positions.push_back(x * Vec3::UnitX() + away * across);
    }
  }
  return positions;
}

std::vector<Piece> extended(std::vector<Piece> pieces, const std::vector<Vec3>& positions) {
  const std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  const std::vector<std::uint8_t> classes(positions.size(), kNonEdge);
  extend_free_ends(pieces, OrderedPoints({positions, normals, classes}), 0.0);
  return pieces;
}

TEST(Extent, OfAFreeEndIsThatOfBothSurfaces) {
  const auto pieces = extended({straight_along_x(10, 24)}, two_faces(2, 30, 30));
  EXPECT_NEAR(pieces[0].ends[0].x(), 2.0, 1.0);
  EXPECT_NEAR(pieces[0].ends[1].x(), 30.0, 1.0);
}

TEST(Extent, EndsWhereOneSurfaceDoes) {
  const auto pieces = extended({straight_along_x(10, 24)}, two_faces(2, 40, 27));
  EXPECT_NEAR(pieces[0].ends[1].x(), 27.0, 1.0);
}

TEST(Extent, IsShorterThanThePieceThatOvershoots) {
  const auto pieces = extended({straight_along_x(10, 33)}, two_faces(2, 30, 30));
  EXPECT_NEAR(pieces[0].ends[1].x(), 30.0, 1.0);
}

TEST(Extent, EndsBesideAnotherPieceOfTheSameDirection) {
  Piece other = straight_along_x(0, 14);
  for (ChainNode& node : other.nodes) node.at += Vec3(22, 1, 0);
  other.fit = fit_segment(other.nodes);
  for (const std::size_t side : {0, 1}) other.ends[side] += Vec3(22, 1, 0);
  other.closed = true;  // its ends are not to meet those of the first
  const auto pieces = extended({straight_along_x(5, 16), other}, two_faces(2, 40, 40));
  EXPECT_LT(pieces[0].ends[1].x(), 23.0);
}

TEST(Extent, ReachesNoFartherThanThePieceIsLong) {
  const auto pieces = extended({straight_along_x(10, 16)}, two_faces(0, 40, 40));
  EXPECT_NEAR(pieces[0].ends[1].x(), 22.0, 0.1);
}

}  // namespace
}  // namespace pcednet::lines
