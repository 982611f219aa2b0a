#include "pcednet/lines/pieces/coaxial.h"

#include <gtest/gtest.h>

#include "lines/made_pieces.h"

namespace pcednet::lines {
namespace {

Piece coaxial_circle() {
  Piece whole = round_about_z(10, 0, 0.0, 6.2);
  whole.closed = true;
  return whole;
}

TEST(Coaxial, PiecesAboutTheAxisOfACircleAreOne) {
  std::vector<Piece> pieces = {coaxial_circle(), round_about_z(20, 5, 0.0, 1.5, 0.4),
                               round_about_z(20, 5, 2.0, 3.5, 0.4), round_about_z(20, 5, 4.0, 5.0)};
  complete_coaxial(pieces, no_points(), 0.2);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_TRUE(pieces[1].closed);
  EXPECT_NEAR(pieces[1].fit.radius, 20.0, 0.1);
  EXPECT_NEAR(pieces[1].fit.point.z(), 5.0, 0.1);
}

TEST(Coaxial, PiecesThatGoLessThanHalfAroundStay) {
  std::vector<Piece> pieces = {coaxial_circle(), round_about_z(20, 5, 0.0, 1.2),
                               round_about_z(20, 5, 2, 3)};
  complete_coaxial(pieces, no_points(), 0.2);
  EXPECT_EQ(pieces.size(), 3u);
}

TEST(Coaxial, PiecesFarAlongTheAxisStay) {
  std::vector<Piece> pieces = {coaxial_circle(), round_about_z(20, 500, 0.0, 2.0),
                               round_about_z(20, 500, 2.5, 5.0)};
  complete_coaxial(pieces, no_points(), 0.2);
  EXPECT_EQ(pieces.size(), 3u);
}

TEST(Coaxial, PiecesOfTwoRadiiStayApart) {
  std::vector<Piece> pieces = {coaxial_circle(), round_about_z(20, 5, 0.0, 2.0),
                               round_about_z(24, 5, 2, 4)};
  complete_coaxial(pieces, no_points(), 0.2);
  EXPECT_EQ(pieces.size(), 3u);
}

TEST(Coaxial, APieceOfUnknownSidesIsACircleOfItsOwn) {
  std::vector<Piece> pieces = {coaxial_circle(), round_about_z(20, 5, 0.0, 5.5)};
  for (ChainNode& node : pieces[1].nodes) node.side_a = node.side_b = Vec3::Zero();
  complete_coaxial(pieces, no_points(), 0.2);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(pieces[1].fit.radius, 20.0, 0.1);
}

TEST(Coaxial, AnotherEdgeInTheGapKeepsItOpenUnlessEdgePointsFollowTheCircle) {
  Piece spoke = straight_along_x(20, 30);  // ends where the gap begins, and goes on outwards
  for (ChainNode& node : spoke.nodes) node.at.z() += 5.0;
  for (Vec3& end : spoke.ends) end.z() += 5.0;
  spoke.fit = fit_segment(spoke.nodes);
  std::vector<Piece> pieces = {coaxial_circle(), round_about_z(20, 5, 0.0, 4.5, 0.4), spoke};
  complete_coaxial(pieces, no_points(), 0.2);
  EXPECT_FALSE(pieces[1].closed);
  complete_coaxial(pieces, EdgeRing(20, 5).points(), 0.2);
  EXPECT_TRUE(pieces[1].closed);
}

}  // namespace
}  // namespace pcednet::lines
