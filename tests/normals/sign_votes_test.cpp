#include "pcednet/normals/sign_votes.h"
#include "pcednet/core/random_vectors.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "normals/shapes.h"
#include "pcednet/normals/estimate.h"
#include "pcednet/normals/neighbour_count.h"

namespace pcednet::normals {
namespace {

/// Two noisy spheres, far apart, with some normals missing.
struct Scene {
  Scene() {
    Shape shape = sphere(1500, 1.0);
    append(shape, sphere(700, 1.0, 4), Vec3(9, 0, 0));
    Random random(3);
    for (Vec3& p : shape.positions) {
      p += 0.03 * normal_vector(random);
    }
    graph = make_neighbour_graph(shape.positions, NeighbourChoice{12});
    normals = estimate_normals(graph);
    for (std::size_t i = 0; i < normals.size(); i += 100) normals[i].setZero();
    links = make_adjacency(graph, 12);
  }
  SignVotes votes() const { return {graph.points, normals, links}; }
  std::map<std::uint32_t, std::int32_t> votes_of(std::uint32_t i) const {
    std::map<std::uint32_t, std::int32_t> found;
    votes().visit(i, [&](std::uint32_t j, std::int32_t vote) { found[j] = vote; });
    return found;
  }
  std::vector<std::uint32_t> linked_with(std::uint32_t i) const {
    std::vector<std::uint32_t> all;
    for (const auto& row : links.of(i)) all.insert(all.end(), row.begin(), row.end());
    EXPECT_EQ(all.size(), links.degree(i));
    return all;
  }

  NeighbourGraph graph;
  std::vector<Vec3> normals;
  Adjacency links;
};

TEST(SignVotes, AreSymmetricAndFollowTheSigns) {
  Scene scene;
  const std::uint32_t i = 1, j = scene.linked_with(i)[0];
  const std::int32_t before = scene.votes_of(i).at(j);
  EXPECT_NE(before, 0);
  EXPECT_EQ(scene.votes_of(j).at(i), before);
  scene.normals[j] = -scene.normals[j];
  EXPECT_EQ(scene.votes_of(i).at(j), -before);
  scene.normals[j].setZero();
  EXPECT_FALSE(scene.votes_of(i).contains(j));
}

TEST(SignVotes, FollowTheirDefinition) {
  const Scene scene;
  for (std::uint32_t i = 0; i < scene.links.size(); ++i) {
    const auto votes = scene.votes_of(i);
    for (const std::uint32_t j : scene.linked_with(i)) {
      const Vec3 &n = scene.normals[i], &m = scene.normals[j];
      if (n.isZero() || m.isZero()) {
        EXPECT_FALSE(votes.contains(j));
        continue;
      }
      const Vec3 e = (scene.graph.points[j] - scene.graph.points[i]).normalized();
      const double expected = n.dot(m) - 1.8 * e.dot(n) * e.dot(m);
      EXPECT_NEAR(votes.at(j) / SignVotes::kUnanimous, expected, 1e-6);
    }
  }
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
    for (const std::uint32_t j : scene.linked_with(i)) links.emplace_back(i, j);
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
      for (const std::uint32_t j : scene.linked_with(i)) {
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
      votes.visit(i, [&](std::uint32_t j, std::int64_t vote) { sum += vote * sign[i] * sign[j]; });
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
