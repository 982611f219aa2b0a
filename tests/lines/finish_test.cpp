#include "pcednet/lines/pieces/finish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lines/made_pieces.h"

namespace pcednet::lines {
namespace {

TEST(Finish, DropsFreePiecesWithHardlyAnEdgePoint) {
  Piece piece = straight({0, 0, 0}, {12, 0, 0});
  for (ChainNode& node : piece.nodes) node.edge_points = 0.05;
  const FinishOptions options = {.tolerance = 0.2, .noise = 0.0};
  EXPECT_TRUE(finish({piece}, options).empty());
  for (ChainNode& node : piece.nodes) node.edge_points = 1.0;
  EXPECT_EQ(finish({piece}, options).size(), 1u);
}

TEST(Finish, WeighsConfidenceByEdgePointsWhoseNumberNeedNotBeWhole) {
  Piece piece = straight({0, 0, 0}, {12, 0, 0});
  for (ChainNode& node : piece.nodes) node.edge_points = 1.5, node.probability = 1.0;
  piece.nodes[0].edge_points = 0.5, piece.nodes[0].probability = 0.5;
  const Curve curve = curve_of(piece, {.tolerance = 0.2, .noise = 0.0});
  EXPECT_NEAR(curve.confidence, (18.0 + 0.25) / 18.5, 1e-12);
  EXPECT_EQ(curve.support, 19u);
}

/// Whether a free piece stays whose nodes have so many edge points, so probable.
bool stays(Piece piece, double edge_points, double probability, double noise) {
  for (ChainNode& node : piece.nodes) {
    node.edge_points = edge_points;
    node.probability = probability;
  }
  return !finish({piece}, {.tolerance = 0.2, .noise = noise}).empty();
}

TEST(Finish, DropsFreePiecesOfDoubtfulPointsInNoise) {
  const Piece piece = straight({0, 0, 0}, {12, 0, 0});
  EXPECT_FALSE(stays(piece, 1.0, 0.7, 0.5));
  EXPECT_FALSE(stays(piece, 1.0, 0.9, 0.5));
  EXPECT_TRUE(stays(piece, 1.0, 0.96, 0.5));
  EXPECT_TRUE(stays(piece, 1.0, 0.7, 0.1));
}

TEST(Finish, KeepsLongRowsOfEdgePointsInNoise) {
  const Piece piece = straight({0, 0, 0}, {30, 0, 0});
  EXPECT_TRUE(stays(piece, 1.0, 0.7, 0.5));
  EXPECT_FALSE(stays(piece, 0.7, 0.7, 0.5)) << "too few edge points";
  EXPECT_FALSE(stays(piece, 1.0, 0.6, 0.5)) << "too doubtful ones";
}

TEST(Finish, KeepsLongRowsThatANarrowToleranceMadePolylines) {
  Piece piece = straight({0, 0, 0}, {30, 0, 0});
  piece.fit.kind = CurveKind::kPolyline;
  EXPECT_TRUE(stays(piece, 1.2, 0.7, 0.5));
  for (ChainNode& node : piece.nodes) node.at.y() = 4.0 * std::sin(node.at.x());
  EXPECT_FALSE(stays(piece, 1.2, 0.7, 0.5)) << "a zigzag";
}

/// A short piece whose ends lie on two longer ones.
std::vector<Piece> between_two(bool of_boundary) {
  std::vector<Piece> pieces = {straight({0, 0, 0}, {4, 0, 0}), straight({0, 0, 0}, {0, 20, 0}),
                               straight({4, 0, 0}, {4, 20, 0})};
  for (Piece& piece : pieces) {
    for (ChainNode& node : piece.nodes) node.edge_points = node.probability = node.sharp = 1.0;
  }
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    for (ChainNode& node : pieces[i].nodes) node.boundary = of_boundary ? 1.0 : 0.0;
  }
  return pieces;
}

TEST(Finish, DropsShortEdgesThatOnlyBoundariesHold) {
  const FinishOptions options = {.tolerance = 0.2, .noise = 0.0};
  EXPECT_EQ(finish(between_two(false), options).size(), 3u);
  const std::vector<Curve> curves = finish(between_two(true), options);
  ASSERT_EQ(curves.size(), 2u);
  for (const Curve& curve : curves) EXPECT_EQ(curve.edge_class, kBoundary);
}

}  // namespace
}  // namespace pcednet::lines
