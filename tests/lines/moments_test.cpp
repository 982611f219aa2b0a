#include "pcednet/lines/points/moments.h"

#include <gtest/gtest.h>

#include <array>

#include "pcednet/core/random.h"

namespace pcednet::lines {
namespace {

TEST(PointMoments, OfRowsAreThoseOfTheirPoints) {
  Random random(3);
  for (const std::size_t count : {0u, 1u, 4u, 5u, 11u}) {
    std::array<double, 12> x{}, y{}, z{}, weight{};
    PointMoments expected;
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = random.normal(), y[i] = random.normal(), z[i] = random.normal();
      weight[i] = random.uniform();
      expected.add({x[i], y[i], z[i]}, weight[i]);
    }
    const PointMoments found = moments_of(x.data(), y.data(), z.data(), weight.data(), count);
    EXPECT_NEAR(found.weight, expected.weight, 1e-12);
    EXPECT_NEAR(found.x + 2.0 * found.y + 3.0 * found.z,
                expected.x + 2.0 * expected.y + 3.0 * expected.z, 1e-12);
    if (count == 0) continue;
    EXPECT_LT((found.covariance() - expected.covariance()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace pcednet::lines
