#include "pcednet/tiles/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pcednet/core/random_vectors.h"
#include "pcednet/gls/scales.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::tiles {
namespace {

TEST(NearestInStream, FindsWhatBruteForceFinds) {
  Random random(11);
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) {
    // Clusters of very different density, copies, and a point far away.
    const double size = std::pow(10.0, random.uniform(-4, 2));
    points.push_back(Vec3(size, 2 * size, 0) + size * normal_vector(random));
    if (i % 50 == 0) points.push_back(points.back());
  }
  points.emplace_back(-7e5, 3e5, 1e3);
  points.push_back(Vec3::Constant(NAN));
  std::vector<std::uint32_t> distinct = spatial::curve_order(points);  // the finite ones
  distinct.erase(std::unique(distinct.begin(), distinct.end(),
                             [&](auto a, auto b) { return points[a] == points[b]; }),
                 distinct.end());
  std::vector<Vec3> places;
  std::vector<double> reach;
  std::vector<std::vector<double>> expected;
  for (std::size_t i = 0; i < 3000; i += 7) {
    std::vector<double> all;
    for (const std::uint32_t k : distinct) all.push_back((points[k] - points[i]).squaredNorm());
    std::sort(all.begin(), all.end());
    all.resize(gls::kSpacingNeighbours);
    places.push_back(points[i]);
    reach.push_back(std::sqrt(all.back()) * (i % 2 == 0 ? 1.0 + 1e-12 : 3.0));
    expected.push_back(all);
  }
  NearestInStream stream(places, reach);
  for (std::size_t begin = 0; begin < points.size(); begin += 500) {
    stream.add(std::span(points).subspan(begin, std::min<std::size_t>(500, points.size() - begin)));
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (std::size_t k = 0; k < gls::kSpacingNeighbours; ++k) {
      EXPECT_DOUBLE_EQ(stream.of(p)[k], expected[p][k]) << "place " << p << ", neighbour " << k;
    }
  }
}

}  // namespace
}  // namespace pcednet::tiles
