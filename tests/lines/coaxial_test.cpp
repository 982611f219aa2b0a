#include "pcednet/lines/coaxial.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcednet::lines {
namespace {

/// Along the x axis.
Piece spoke_of(double from, double to) {
  Piece piece;
  for (double x = from; x <= to; x += 1.0) {
    piece.nodes.push_back({.at = x * Vec3::UnitX(),
                           .along = Vec3::UnitX(),
                           .side_a = Vec3::UnitY(),
                           .side_b = Vec3::UnitZ(),
                           .spacing = 1.0});
  }
  piece.fit = fit_segment(piece.nodes);
  piece.ends = {piece.nodes.front().at, piece.nodes.back().at};
  return piece;
}

/// Part of the circle of this radius about the z axis, its nodes off it by `off` in turn.
Piece piece_about_z(double radius, double height, double from, double to, double off = 0.0) {
  Piece piece;
  double sign = 1.0;
  for (double t = from; t <= to; t += 1.0 / radius) {
    const Vec3 out(std::cos(t), std::sin(t), 0);
    sign = -sign;
    piece.nodes.push_back({.at = (radius + sign * off) * out + height * Vec3::UnitZ(),
                           .along = {-std::sin(t), std::cos(t), 0},
                           .side_a = out,
                           .side_b = Vec3::UnitZ(),
                           .spacing = 1.0});
  }
  piece.fit = fit_arc(piece.nodes);
  piece.ends = {piece.nodes.front().at, piece.nodes.back().at};
  return piece;
}

Piece coaxial_circle() {
  Piece whole = piece_about_z(10, 0, 0.0, 6.2);
  whole.closed = true;
  return whole;
}

TEST(Coaxial, PiecesAboutTheAxisOfACircleAreOne) {
  std::vector<Piece> pieces = {coaxial_circle(), piece_about_z(20, 5, 0.0, 1.5, 0.4),
                               piece_about_z(20, 5, 2.0, 3.5, 0.4), piece_about_z(20, 5, 4.0, 5.0)};
  complete_coaxial(pieces, 0.2);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_TRUE(pieces[1].closed);
  EXPECT_NEAR(pieces[1].fit.radius, 20.0, 0.1);
  EXPECT_NEAR(pieces[1].fit.point.z(), 5.0, 0.1);
}

TEST(Coaxial, PiecesThatGoLessThanHalfAroundStay) {
  std::vector<Piece> pieces = {coaxial_circle(), piece_about_z(20, 5, 0.0, 1.2),
                               piece_about_z(20, 5, 2, 3)};
  complete_coaxial(pieces, 0.2);
  EXPECT_EQ(pieces.size(), 3u);
}

TEST(Coaxial, PiecesOfTwoRadiiStayApart) {
  std::vector<Piece> pieces = {coaxial_circle(), piece_about_z(20, 5, 0.0, 2.0),
                               piece_about_z(24, 5, 2, 4)};
  complete_coaxial(pieces, 0.2);
  EXPECT_EQ(pieces.size(), 3u);
}

TEST(Coaxial, AnotherEdgeInTheGapKeepsItOpen) {
  Piece spoke = spoke_of(20, 30);  // ends where the gap begins, and goes on outwards
  for (ChainNode& node : spoke.nodes) node.at.z() += 5.0;
  for (Vec3& end : spoke.ends) end.z() += 5.0;
  spoke.fit = fit_segment(spoke.nodes);
  std::vector<Piece> pieces = {coaxial_circle(), piece_about_z(20, 5, 0.0, 4.5), spoke};
  complete_coaxial(pieces, 0.2);
  EXPECT_FALSE(pieces[1].closed);
}

}  // namespace
}  // namespace pcednet::lines
