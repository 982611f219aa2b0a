#include "pcednet/lines/pieces/bores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::lines {
namespace {

constexpr double kBoreRadius = 2.3, kDepth = 3.0, kSide = 20.0;  // in spacings

/// A plate's top at z = 0 with something round in its middle, one point per unit of area. Edge
/// points are those nearer than 0.7 to the rim at the top.
struct Part {
  std::vector<Vec3> positions = {}, normals = {};
  std::vector<std::uint8_t> classes = {};
  Random random = Random(5);

  void add(const Vec3& position, const Vec3& normal) {
    const double out = std::hypot(position.x(), position.y()) - kBoreRadius;
    positions.push_back(position);
    normals.push_back(normal);
    classes.push_back(std::hypot(out, position.z()) < 0.7 ? kSharpEdge : kNonEdge);
  }
  void add_plane_with_hole() {
    for (int i = 0; i < static_cast<int>(kSide * kSide); ++i) {
      const double y = random.uniform() - 0.5, x = random.uniform() - 0.5;
      const Vec3 p(x * kSide, y * kSide, 0.0);
      if (std::hypot(p.x(), p.y()) > kBoreRadius) add(p, Vec3::UnitZ());
    }
  }
  void add_disc() {
    for (int i = 0; i < 17; ++i) {
      const double angle = 2.0 * std::numbers::pi * random.uniform();
      const double radius = kBoreRadius * std::sqrt(random.uniform());
      add(radius * Vec3(std::cos(angle), std::sin(angle), 0.0), Vec3::UnitZ());
    }
  }
  void add_wall(double from, double to, double sign) {
    const double area = 2.0 * std::numbers::pi * kBoreRadius * (to - from);
    for (int i = 0; i < static_cast<int>(area); ++i) {
      const double angle = 2.0 * std::numbers::pi * random.uniform();
      const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
      add(kBoreRadius * out + (from + (to - from) * random.uniform()) * Vec3::UnitZ(), sign * out);
    }
  }
  std::vector<Piece> bores(double noise = 0.0) const {
    std::vector<Piece> pieces;
    find_bores(pieces, OrderedPoints({positions, normals, classes}),
               {1.0, noise, true, noise < kExactNoise}, nullptr);
    return pieces;
  }
};

void expect_the_rim(const std::vector<Piece>& pieces) {
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(pieces[0].closed);
  EXPECT_NEAR(pieces[0].fit.radius, kBoreRadius, 0.05);
  EXPECT_LT(pieces[0].fit.point.norm(), 0.05);
  EXPECT_GT(pieces[0].middle().edge_points, 0.0);
  EXPECT_EQ(pieces[0].middle().probability, 1.0);
}

TEST(Bores, EndInACircleWhereTheyEnterAPlane) {
  Part part;
  part.add_plane_with_hole();
  part.add_wall(-kDepth, 0.0, -1.0);
  const auto pieces = part.bores();
  expect_the_rim(pieces);
  EXPECT_LT(pieces[0].middle().side_a.z(), -0.99);  // down the wall
}

TEST(Bores, PinsEndInOneToo) {
  Part part;
  part.add_disc();
  part.add_wall(-kDepth, 0.0, 1.0);
  const auto pieces = part.bores();
  expect_the_rim(pieces);
  const ChainNode& node = pieces[0].middle();
  EXPECT_LT(node.side_b.dot(node.at - pieces[0].fit.point), 0.0);  // into the disc
}

TEST(Bores, TakeThePlaceOfThePiecesThere) {
  Part part;
  part.add_plane_with_hole();
  part.add_wall(-kDepth, 0.0, -1.0);
  ChainNode node{.at = {kBoreRadius, -1.0, 0.0},
                 .along = Vec3::UnitY(),
                 .side_a = -Vec3::UnitZ(),
                 .side_b = Vec3::UnitX(),
                 .spacing = 1.0};
  Piece chord{.fit = {}, .nodes = {node, node}, .ends = {}};
  chord.nodes[1].at.y() = 1.0;
  chord.fit = fit_segment(chord.nodes);
  chord.ends = {chord.nodes[0].at, chord.nodes[1].at};
  std::vector<Piece> pieces = {chord};
  find_bores(pieces, OrderedPoints({part.positions, part.normals, part.classes}),
             {1.0, 0.0, true, true}, nullptr);
  expect_the_rim(pieces);
}

TEST(Bores, NeedAPlaneThatEndsAtTheWall) {
  Part through;  // a pin that goes on above the plane
  through.add_plane_with_hole();
  through.add_wall(-kDepth, kDepth, 1.0);
  EXPECT_TRUE(through.bores().empty());

  Part painted;  // edge points in a plane
  painted.add_plane_with_hole();
  painted.add_disc();
  EXPECT_TRUE(painted.bores().empty());
}

TEST(Bores, OfExactPointsNeedFewOfThem) {
  Part tube;  // a ring around the bore ends 0.9 spacings from it in a wall of its own
  for (int i = 0; i < static_cast<int>(kSide * kSide); ++i) {
    const double y = tube.random.uniform() - 0.5, x = tube.random.uniform() - 0.5;
    const Vec3 p(x * kSide, y * kSide, 0.0);
    const double out = std::hypot(p.x(), p.y()) - kBoreRadius;
    if (out > 0.0 && out < 0.9) tube.add(p, Vec3::UnitZ());
  }
  tube.add_wall(-kDepth, 0.0, -1.0);
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * std::numbers::pi * tube.random.uniform();
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    tube.add((kBoreRadius + 0.9) * out - kDepth * tube.random.uniform() * Vec3::UnitZ(), out);
  }
  expect_the_rim(tube.bores());
  EXPECT_TRUE(tube.bores(0.02).empty());
}

/// A hexagonal hole in place of the bore, with the segments along its edges but for some.
struct HexagonalHole : Part {
  static constexpr double kCorner = 3.2;  // from the axis

  static Vec3 corner(int i) {
    const double angle = std::numbers::pi / 3.0 * i;
    return kCorner * Vec3(std::cos(angle), std::sin(angle), 0.0);
  }
  /// The distance from the nearest side, in the plane.
  static double out_of(const Vec3& p) {
    double out = -kCorner;
    for (int i = 0; i < 6; ++i) {
      const Vec3 middle = 0.5 * (corner(i) + corner(i + 1));
      out = std::max(out, p.dot(middle.normalized()) - middle.norm());
    }
    return out;
  }

  HexagonalHole() {
    const auto add_point = [&](const Vec3& position, const Vec3& normal) {
      add(position, normal);
      classes.back() = std::hypot(out_of(position), position.z()) < 0.7 ? kSharpEdge : kNonEdge;
    };
    for (int i = 0; i < static_cast<int>(kSide * kSide); ++i) {
      const double y = random.uniform() - 0.5, x = random.uniform() - 0.5;
      const Vec3 p(x * kSide, y * kSide, 0.0);
      if (out_of(p) > 0.0) add_point(p, Vec3::UnitZ());
    }
    for (int i = 0; i < 6; ++i) {
      const Vec3 side = corner(i + 1) - corner(i), in = -(corner(i) + corner(i + 1)).normalized();
      for (int k = 0; k < static_cast<int>(kCorner * kDepth); ++k) {
        add_point(corner(i) + random.uniform() * side - kDepth * random.uniform() * Vec3::UnitZ(),
                  in);
      }
    }
  }

  std::vector<Piece> with_edges(int count) const {
    std::vector<Piece> pieces;
    for (int i = 0; i < count; ++i) {
      ChainNode node{.at = corner(i) - Vec3::UnitZ(),
                     .along = -Vec3::UnitZ(),
                     .side_a = (corner(i + 1) - corner(i)).normalized(),
                     .side_b = (corner(i + 5) - corner(i)).normalized(),
                     .spacing = 1.0};
      Piece edge{.fit = {}, .nodes = {node, node}, .ends = {}};
      edge.nodes[1].at.z() = -kDepth;
      edge.fit = fit_segment(edge.nodes);
      edge.ends = {edge.nodes[0].at, edge.nodes[1].at};
      pieces.push_back(edge);
    }
    find_bores(pieces, OrderedPoints({positions, normals, classes}), {1.0, 0.0, true, true},
               nullptr);
    return pieces;
  }
};

TEST(Bores, OfPrismsArePolygons) {
  const HexagonalHole hole;
  for (const int edges : {6, 5}) {  // the sixth is where the others leave a gap
    const auto pieces = hole.with_edges(edges);
    ASSERT_EQ(pieces.size(), static_cast<std::size_t>(edges + 6));
    for (std::size_t i = pieces.size() - 6; i < pieces.size(); ++i) {
      const Piece& side = pieces[i];
      EXPECT_EQ(side.fit.kind, CurveKind::kSegment);
      EXPECT_TRUE(side.exact);  // however short
      EXPECT_NEAR((side.ends[1] - side.ends[0]).norm(), HexagonalHole::kCorner, 0.2);
      for (const Vec3& end : side.ends) {
        double nearest = 1.0;
        for (int k = 0; k < 6; ++k) {
          nearest = std::min(nearest, (HexagonalHole::corner(k) - end).norm());
        }
        EXPECT_LT(nearest, 0.15);
      }
      EXPECT_GT(side.middle().edge_points, 0.0);
    }
  }
}

TEST(Bores, OfPrismsNeedEdgesAllAround) {
  const auto pieces = HexagonalHole().with_edges(2);
  EXPECT_FALSE(pieces.empty());
  for (const Piece& piece : pieces) {
    EXPECT_TRUE(piece.closed || std::abs(piece.fit.direction.z()) > 0.99);
  }
}

TEST(Bores, AreNotLookedForInMuchNoise) {
  Part part;
  part.add_plane_with_hole();
  part.add_wall(-kDepth, 0.0, -1.0);
  EXPECT_TRUE(part.bores(0.5).empty());
}

}  // namespace
}  // namespace pcednet::lines
