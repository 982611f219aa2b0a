#include "pcednet/normals/side_votes.h"

#include <gtest/gtest.h>

#include "normals/shapes.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/orient.h"
#include "pcednet/normals/prepare.h"

namespace pcednet::normals {
namespace {

/// A square pyramid or a cone on z = 0, evenly sampled: base of half width 1, given height.
Shape pointed(std::size_t count, double height, bool round) {
  Random random(7);
  const double slope = std::hypot(1.0, height);
  Shape shape;
  while (shape.positions.size() < count) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    const double out = round ? std::hypot(x, y) : std::max(std::abs(x), std::abs(y));
    if (out > 1.0) continue;
    if (random.uniform(0, 1.0 + slope) < 1.0) {
      shape.positions.emplace_back(x, y, 0.0);
      shape.normals.emplace_back(0, 0, -1);
      continue;
    }
    const Vec3 along_x(x < 0 ? -1.0 : 1.0, 0, 0), along_y(0, y < 0 ? -1.0 : 1.0, 0);
    const Vec3 away = round                       ? Vec3(x / out, y / out, 0)
                      : std::abs(x) > std::abs(y) ? along_x
                                                  : along_y;
    shape.positions.emplace_back(x, y, height * (1.0 - out));
    shape.normals.push_back((height * away + Vec3::UnitZ()) / slope);
  }
  return shape;
}

TEST(SideVotes, TurnTheFacesOfPyramidsAndConesOutwards) {
  for (const bool round : {false, true}) {
    for (const double height : {0.6, 0.7, 1.0, 1.4, 2.0, 4.0}) {
      const Shape shape = pointed(20000, height, round);
      const PreparedNormals prepared = estimate_oriented_normals(shape.positions);
      EXPECT_GT(agreement(shape, prepared.normals), 0.94) << height << ' ' << round;
      EXPECT_EQ(prepared.orientation.undecided, 0u) << height << ' ' << round;
    }
  }
}

TEST(SideVotes, StandNoise) {
  Random random(8);
  for (const bool round : {false, true}) {
    Shape shape = pointed(20000, 0.7, round);
    for (Vec3& p : shape.positions) p += 0.3 * 0.02 * normal_vector(random);
    const PreparedNormals prepared = estimate_oriented_normals(shape.positions);
    EXPECT_GT(agreement(shape, prepared.normals), 0.9) << round;
    EXPECT_EQ(prepared.orientation.undecided, 0u) << round;
  }
}

TEST(SideVotes, DoNotTakeAStepForAWall) {
  // Two sheets, one 1.5 spacings above the other and beside it: as behind the edge of a pillar.
  Random random(9);
  Shape shape;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    shape.positions.emplace_back(x < 0 ? x - 0.02 : x + 0.02, y, x < 0 ? 0.0 : 0.03);
    shape.normals.emplace_back(0, 0, 1);
  }
  EXPECT_EQ(agreement(shape, estimate_oriented_normals(shape.positions).normals), 1.0);
}

TEST(SideVotes, AreTheSameForAnyOrderAndNumberOfThreads) {
  const Shape shape = pointed(5000, 0.6, false);
  const auto expected = estimate_oriented_normals(shape.positions).normals;
  set_thread_count(1);
  EXPECT_EQ(estimate_oriented_normals(shape.positions).normals, expected);
  set_thread_count(0);
  const std::vector<Vec3> reversed(shape.positions.rbegin(), shape.positions.rend());
  EXPECT_EQ(estimate_oriented_normals(reversed).normals,
            std::vector<Vec3>(expected.rbegin(), expected.rend()));
}

/// Two faces of a wedge as patches, each with its points' outward normals turned by `sign`.
struct Wedge {
  explicit Wedge(double angle) {
    Random random(10);
    for (std::size_t i = 0; i < 600; ++i) {
      const double a = i % 2 == 0 ? 0.0 : angle, r = random.uniform(0.05, 1.0);
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      points.emplace_back(r * std::cos(a), random.uniform(0, 2), r * std::sin(a));
      normals.emplace_back(-side * std::sin(a), 0.0, side * std::cos(a));
    }
    graph = make_neighbour_graph(points, NeighbourChoice{12});
    std::vector<Vec3> of_points(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) of_points[graph.point_of[i]] = normals[i];
    normals = of_points;
    links = make_adjacency(graph, 12);
    faces.sign.assign(points.size(), 1);
    faces.part.resize(points.size());
    faces.parts = 2;
    for (std::size_t i = 0; i < points.size(); ++i) {
      faces.part[i] = normals[i].z() < 0.0 ? 0 : 1;
    }
  }
  std::vector<PartVote> votes() const {
    return votes_of_sides(SignVotes(graph.points, normals, links), faces);
  }

  std::vector<Vec3> points, normals;
  NeighbourGraph graph;
  Adjacency links;
  Signs faces;
};

TEST(SideVotes, OfAWedgeAreForOutwardNormalsAndSymmetric) {
  for (const double degrees : {20.0, 30.0, 40.0, 50.0}) {
    Wedge wedge(degrees * std::numbers::pi / 180);
    const auto votes = wedge.votes();
    ASSERT_EQ(votes.size(), 2u) << degrees;
    EXPECT_EQ(votes[0].part, 0u);
    EXPECT_EQ(votes[1].part, 1u);
    EXPECT_GT(votes[0].vote, 0) << degrees;
    EXPECT_EQ(votes[0].vote, votes[1].vote) << degrees;
    // The other sign of one face.
    for (std::size_t i = 0; i < wedge.points.size(); ++i) {
      wedge.faces.sign[i] = wedge.faces.part[i] == 0 ? 1 : -1;
    }
    EXPECT_EQ(wedge.votes()[0].vote, -votes[0].vote) << degrees;
  }
}

TEST(SideVotes, AreNoneWithoutAnEdge) {
  Wedge plane(std::numbers::pi);
  for (std::size_t i = 0; i < plane.points.size(); ++i) plane.normals[i] = Vec3::UnitZ();
  EXPECT_TRUE(plane.votes().empty());
}

}  // namespace
}  // namespace pcednet::normals
