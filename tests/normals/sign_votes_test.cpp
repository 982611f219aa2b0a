#include "pcednet/normals/sign_votes.h"

#include <gtest/gtest.h>

#include <set>

#include "normals/shapes.h"
#include "pcednet/normals/estimate.h"

namespace pcednet::normals {
namespace {

/// Two noisy spheres, far apart, with some normals missing.
struct Scene {
  Scene() {
    Shape shape = sphere(1500, 1.0);
    append(shape, sphere(700, 1.0, 4), Vec3(9, 0, 0));
    Random random(3);
    for (Vec3& p : shape.positions) {
      p += 0.03 * Vec3(random.normal(), random.normal(), random.normal());
    }
    graph = make_neighbour_graph(shape.positions, 12, nullptr);
    normals = estimate_normals(graph);
    for (std::size_t i = 0; i < normals.size(); i += 100) normals[i].setZero();
    links = make_adjacency(graph, 12);
  }
  SignVotes votes() const { return {graph.points, normals, links}; }

  NeighbourGraph graph;
  std::vector<Vec3> normals;
  Adjacency links;
};

TEST(SignVotes, AreSymmetricAndFollowTheSigns) {
  Scene scene;
  const std::int64_t before = scene.votes().vote(1, 2);
  EXPECT_NE(before, 0);
  EXPECT_EQ(scene.votes().vote(2, 1), before);
  scene.normals[2] = -scene.normals[2];
  EXPECT_EQ(scene.votes().vote(1, 2), -before);
}

TEST(SignVotes, LinksAreTheNeighboursOfBothSides) {
  const Scene scene;
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
  for (std::uint32_t i = 0; i < scene.graph.points.size(); ++i) {
    for (const std::uint32_t j : scene.graph.of(i)) expected.insert({i, j});
    for (const std::uint32_t j : scene.graph.of(i)) expected.insert({j, i});
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
  for (std::uint32_t i = 0; i < scene.links.size(); ++i) {
    for (const std::uint32_t j : scene.links.of(i)) links.emplace_back(i, j);
  }
  std::sort(links.begin(), links.end());
  EXPECT_EQ(links, std::vector(expected.begin(), expected.end()));
}

TEST(SignVotes, PartsAreWhatAWalkAlongTheLinksReaches) {
  const Scene scene;
  const Signs signs = contract(scene.votes());
  std::vector<std::uint32_t> reached(scene.normals.size(), kNoPoint);
  std::uint32_t parts = 0;
  for (std::uint32_t start = 0; start < reached.size(); ++start) {
    if (reached[start] != kNoPoint) continue;
    std::vector<std::uint32_t> open = {start};
    reached[start] = parts;
    while (!open.empty()) {
      const std::uint32_t i = open.back();
      open.pop_back();
      for (const std::uint32_t j : scene.links.of(i)) {
        if (reached[j] != kNoPoint || scene.normals[i].isZero() || scene.normals[j].isZero()) {
          continue;
        }
        reached[j] = parts;
        open.push_back(j);
      }
    }
    ++parts;
  }
  EXPECT_EQ(signs.parts, parts);
  EXPECT_EQ(signs.part, reached);
}

TEST(SignVotes, NoPointStaysOutvoted) {
  const Scene scene;
  const SignVotes votes = scene.votes();
  const auto outvoted = [&](const std::vector<std::int8_t>& sign) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < sign.size(); ++i) {
      std::int64_t sum = 0;
      for (const std::uint32_t j : scene.links.of(i)) sum += votes.vote(i, j) * sign[i] * sign[j];
      count += sum < 0;
    }
    return count;
  };
  Signs signs = contract(votes);
  EXPECT_GT(outvoted(signs.sign), 0u);
  turn_outvoted_points(votes, signs.sign);
  EXPECT_EQ(outvoted(signs.sign), 0u);
}

}  // namespace
}  // namespace pcednet::normals
