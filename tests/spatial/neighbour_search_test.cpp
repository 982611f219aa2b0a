#include "pcednet/spatial/neighbour_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::spatial {
namespace {

std::vector<Vec3> in_curve_order(const std::vector<Vec3>& points) {
  std::vector<Vec3> ordered;
  for (const std::uint32_t i : curve_order(points)) ordered.push_back(points[i]);
  return ordered;
}

std::vector<Neighbour> brute_force(const std::vector<Vec3>& points, std::size_t point,
                                   std::size_t count) {
  std::vector<Neighbour> all;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3 d = points[i] - points[point];
    if (i != point) all.push_back({i, d.x() * d.x() + d.y() * d.y() + d.z() * d.z()});
  }
  std::stable_sort(all.begin(), all.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.sq_distance < b.sq_distance;
  });
  all.resize(std::min(count, all.size()));
  return all;
}

/// Expects the neighbours of every `nth` point to be those of a sort of all distances.
void expect_exact(const std::vector<Vec3>& points, std::size_t count, std::size_t nth) {
  const NeighbourSearch search(points);
  ASSERT_EQ(search.size(), points.size());
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < points.size(); i += static_cast<std::uint32_t>(nth)) {
    chosen.push_back(i);
  }
  const std::size_t width = search.available(count);
  std::vector<Neighbour> found(chosen.size() * width);
  search.nearest_others(chosen, count, found);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto expected = brute_force(points, chosen[i], count);
    ASSERT_EQ(expected.size(), width);
    for (std::size_t k = 0; k < width; ++k) {
      ASSERT_EQ(found[i * width + k].index, expected[k].index) << "of " << chosen[i];
      ASSERT_EQ(found[i * width + k].sq_distance, expected[k].sq_distance);
    }
  }
}

std::map<std::string, std::vector<Vec3>> distributions() {
  Random random(7);
  const auto place = [&] { return uniform_vector(random); };
  const std::map<std::string, std::function<Vec3(int)>> kinds = {
      {"a ball's surface", [&](int) { return (place() - Vec3::Constant(0.5)).normalized(); }},
      {"vegetation", [&](int) { return place(); }},
      {"a line", [&](int) { return Vec3(Vec3(1, 2, -3) * random.uniform()); }},
      {"a grid with its many equal distances",
       [&](int i) { return Vec3(i % 12, i / 12 % 12, i / 144); }},
      {"clumps a thousand times as dense",
       [&](int i) { return i % 2 ? Vec3(10 * place()) : Vec3(i % 5, 3, i % 3) + 1e-3 * place(); }},
      {"points far away", [&](int i) { return i % 50 ? place() : Vec3(1e9 * place()); }},
      {"every density at once",
       [&](int) { return Vec3(std::exp(-30.0 * random.uniform()) * place()); }},
      {"copies", [&](int i) { return i % 3 ? Vec3(Vec3::Ones()) : Vec3(i % 7, i % 11, 0); }},
      {"national coordinates", [&](int) { return Vec3(Vec3(4.5e6, 5.4e6, 100) + place()); }},
      {"very small", [&](int) { return Vec3(1e-150 * place()); }},
      {"very large", [&](int) { return Vec3(1e150 * place()); }},
      {"too large to be squared", [&](int) { return Vec3(1e200 * place()); }}};
  std::map<std::string, std::vector<Vec3>> all;
  for (const auto& [name, make] : kinds) {
    for (int i = 0; i < 1500; ++i) all[name].push_back(make(i));
    all[name] = in_curve_order(all[name]);
  }
  return all;
}

TEST(NeighbourSearch, FindsWhatASortOfAllDistancesFinds) {
  for (const auto& [name, points] : distributions()) {
    SCOPED_TRACE(name);
    for (const std::size_t count : {1u, 12u, 33u, 100u}) expect_exact(points, count, 1);
    expect_exact(points, 12, 7);
  }
}

TEST(NeighbourSearch, GivesAllOthersWhereThereAreFew) {
  EXPECT_EQ(NeighbourSearch({}).available(5), 0u);
  NeighbourSearch({}).nearest_others({}, 5, {});
  for (const std::size_t size : {1u, 2u, 17u}) {
    std::vector<Vec3> points(size, Vec3::Zero());
    expect_exact(points, 40, 1);  // copies of one point
    for (std::size_t i = 0; i < size; ++i) points[i].x() = static_cast<double>(i);
    expect_exact(points, 40, 1);
  }
}

TEST(NeighbourSearch, FindsAllWithinARadius) {
  Random random(11);
  for (const auto& [name, points] : distributions()) {
    SCOPED_TRACE(name);
    const NeighbourSearch search(points);
    std::vector<Neighbour> found;
    for (int trial = 0; trial < 40; ++trial) {
      const Vec3 &at = points[random.index(points.size())],
                 &b = points[random.index(points.size())];
      const double radius = (b - at).norm();  // b itself is not within
      search.within(at, radius, found);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec3 d = points[i] - at;
        const double sq_distance = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
        if (sq_distance < radius * radius) expected.push_back(i);
      }
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) ASSERT_EQ(found[k].index, expected[k]);
    }
  }
  std::vector<Neighbour> none = {{7, 1.0}};
  NeighbourSearch({}).within(Vec3::Zero(), 1.0, none);
  EXPECT_TRUE(none.empty());
}

// A search that looks at every copy for every copy would run into the time limit.
TEST(NeighbourSearch, TakesManyCopiesOfOnePoint) {
  std::vector<Vec3> points(200000, Vec3(1, 2, 3));
  points.front().x() = 0;
  const NeighbourSearch search(points);
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<Neighbour> found(all.size() * 12);
  search.nearest_others(all, 12, found);
  for (std::uint32_t i = 0; i < 12; ++i) {
    EXPECT_EQ(found[i].index, i + 1);
    EXPECT_EQ(found[i].sq_distance, 1.0);
    EXPECT_EQ(found[found.size() - 12 + i].index, i + 1);
    EXPECT_EQ(found[found.size() - 12 + i].sq_distance, 0.0);
  }
}

}  // namespace
}  // namespace pcednet::spatial
