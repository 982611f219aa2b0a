#include "workbench/render/surfels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pcednet/core/random_vectors.h"

namespace pcednet::render {
namespace {

std::vector<Vec3> random_sphere(std::size_t count) {
  Random random(3);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = normal_vector(random).normalized();
  return points;
}

TEST(NearPoints, AreMostlyTheNearest) {
  const std::vector<Vec3> points = random_sphere(2000);
  const std::vector<NearPoints> near = near_points(points);
  ASSERT_EQ(near.size(), points.size());
  double excess = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<double> distances;
    for (const Vec3& p : points) distances.push_back((p - points[i]).norm());
    std::nth_element(distances.begin(), distances.begin() + NearPoints::kMost, distances.end());
    ASSERT_EQ(near[i].count, NearPoints::kMost);
    excess += near[i].distance.back() / distances[NearPoints::kMost] - 1.0;
  }
  // The eighth that is found lies little farther than the true eighth.
  EXPECT_LT(excess / static_cast<double>(points.size()), 0.10);
}

TEST(NearPoints, AreSortedAndDistinct) {
  const std::vector<Vec3> points = random_sphere(500);
  const std::vector<NearPoints> near = near_points(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < near[i].count; ++k) {
      const std::uint32_t other = near[i].index[k];
      EXPECT_NE(other, i);
      EXPECT_FLOAT_EQ(near[i].distance[k], static_cast<float>((points[other] - points[i]).norm()));
      EXPECT_GE(near[i].distance[k], near[i].distance[k > 0 ? k - 1 : 0]);
      for (std::size_t m = 0; m < k; ++m) EXPECT_NE(near[i].index[m], other);
    }
  }
}

TEST(NearPoints, LeaveOutDuplicates) {
  EXPECT_EQ(near_points(std::vector<Vec3>(50, Vec3(1, 2, 3)))[7].count, 0u);
  EXPECT_EQ(near_points(std::vector<Vec3>{Vec3(1, 2, 3)})[0].count, 0u);
  const std::vector<NearPoints> pair = near_points(std::vector<Vec3>{Vec3(0, 0, 0), Vec3(0, 3, 4)});
  ASSERT_EQ(pair[0].count, 1u);
  EXPECT_EQ(pair[0].index[0], 1u);
  EXPECT_EQ(pair[0].distance[0], 5.0f);
}

}  // namespace
}  // namespace pcednet::render
