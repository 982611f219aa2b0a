#include "pcednet/detect/crease_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "labelled_cube.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kPoints = 6000;
const double kCubeUnit = 1.2 * std::sqrt(6.0 / kPoints);

std::vector<float> distances_of(const std::vector<Vec3>& positions, double unit) {
  const std::vector<std::uint8_t> all(positions.size(), 1);
  return crease_distances(positions, spatial::curve_order(positions), all, unit);
}

/// From a point of the unit cube about the origin to its nearest edge.
double to_edge(const Vec3& p) {
  Vec3 away = (0.5 - p.cwiseAbs().array()).matrix();
  std::sort(away.data(), away.data() + 3);
  return away[1];
}

/// The share of the points nearer than 1.4 units to an edge whose distance is found to 0.05.
template <typename ToEdge>
double share_found(const std::vector<Vec3>& positions, double unit, const ToEdge& to_edge) {
  const auto distances = distances_of(positions, unit);
  double near = 0.0, found = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double true_distance = to_edge(positions[i]) / unit;
    if (true_distance > 1.4) continue;
    near += 1.0;
    found += std::abs(static_cast<double>(distances[i]) - true_distance) < 0.05 ? 1.0 : 0.0;
  }
  return found / near;
}

TEST(CreaseDistance, IsThatToTheEdgesOfACube) {
  EXPECT_GT(share_found(cube(kPoints, 1).positions, kCubeUnit, to_edge), 0.95);
}

TEST(CreaseDistance, IsThatToTheRimsOfACylinder) {
  constexpr double kRadius = 0.5, kHeight = 1.0;
  Random random(2);
  std::vector<Vec3> positions;
  while (positions.size() < kPoints) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    if (random.index(3) > 0) {  // the side has two thirds of the area
      positions.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle),
                             random.uniform(0.0, kHeight));
    } else {
      const double r = kRadius * std::sqrt(random.uniform());
      positions.emplace_back(r * std::cos(angle), r * std::sin(angle),
                             random.index(2) == 0 ? 0.0 : kHeight);
    }
  }
  const double area = 3.0 * std::numbers::pi * kRadius * kHeight;
  const double unit = 1.2 * std::sqrt(area / kPoints);
  EXPECT_GT(share_found(positions, unit,
                        [](const Vec3& p) {
                          const double r = p.head<2>().norm();
                          return kRadius - r > 1e-6 ? kRadius - r
                                                    : std::min(p.z(), kHeight - p.z());
                        }),
            0.8);
}

TEST(CreaseDistance, IsInfiniteWhereThereIsNone) {
  const auto positions = cube(kPoints, 3).positions;
  const auto distances = distances_of(positions, kCubeUnit);
  std::size_t far = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (to_edge(positions[i]) <= 5.0 * kCubeUnit) continue;
    ++far;
    EXPECT_TRUE(std::isinf(distances[i])) << i;
  }
  EXPECT_GT(far, positions.size() / 10);
  const std::vector<std::uint8_t> none(positions.size(), 0);
  for (const float distance :
       crease_distances(positions, spatial::curve_order(positions), none, kCubeUnit)) {
    EXPECT_TRUE(std::isinf(distance));
  }
  for (const std::size_t few : {0, 1, 2, 5, 20}) {
    const auto some =
        std::vector<Vec3>(positions.begin(), positions.begin() + static_cast<std::ptrdiff_t>(few));
    EXPECT_EQ(distances_of(some, kCubeUnit).size(), few);
  }
}

TEST(CreaseDistance, IsTheSameForAnyThreadsAndOrderAndForPointsThatAreNotFinite) {
  auto positions = cube(kPoints, 4).positions;
  const auto expected = distances_of(positions, kCubeUnit);
  set_thread_count(1);
  EXPECT_EQ(distances_of(positions, kCubeUnit), expected);
  set_thread_count(0);
  std::reverse(positions.begin(), positions.end());
  positions.push_back(Vec3::Constant(std::nan("")));
  auto turned = distances_of(positions, kCubeUnit);
  EXPECT_TRUE(std::isinf(turned.back()));
  turned.pop_back();
  std::reverse(turned.begin(), turned.end());
  EXPECT_EQ(turned, expected);
}

}  // namespace
}  // namespace pcednet::detect
