#include "pcednet/detect/points/rounding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

constexpr double kStep = 0.05;

Vec3 rounded(const Vec3& p, double step) {
  return Vec3(std::round(p.x() / step), std::round(p.y() / step), std::round(p.z() / step)) * step;
}

/// A roof of two slopes over a square of 10 x 10, one point per 0.01 of the area on average.
std::vector<Vec3> roof(double step) {
  Random random(1);
  std::vector<Vec3> positions;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-5.0, 5.0), y = random.uniform(-5.0, 5.0);
    positions.push_back(Vec3(x, y, 3.0 - 0.4 * std::abs(x + 0.3 * y)));
    if (step > 0.0) positions.back() = rounded(positions.back(), step);
  }
  return positions;
}

Rounding rounding_of(const std::vector<Vec3>& positions) {
  return find_rounding(positions, spatial::curve_order(positions));
}

TEST(Rounding, IsFoundWhereverTheOriginIs) {
  std::vector<Vec3> positions = roof(kStep);
  const Rounding found = rounding_of(positions);
  EXPECT_NEAR(found.step, kStep, 1e-12);
  EXPECT_NEAR(found.spacing, 0.1, 0.02);
  const std::vector<Vec3> here = spread(positions, found);
  const Vec3 far(431000.123, 5412000.456, -7.0);
  for (Vec3& p : positions) p += far;
  const Rounding there = rounding_of(positions);
  EXPECT_NEAR(there.step, kStep, 1e-9);
  const std::vector<Vec3> moved = spread(positions, there);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    ASSERT_LT((moved[i] - far - here[i]).norm(), 1e-8);
  }
}

TEST(Rounding, IsFoundInSinglePrecision) {
  std::vector<Vec3> positions = roof(kStep);
  for (Vec3& p : positions) p = (p + Vec3(2000.0, 900.0, 0.0)).cast<float>().cast<double>();
  EXPECT_NEAR(rounding_of(positions).step, kStep, 1e-4);
}

TEST(Rounding, IsNoneIfFineOrOfOneAxis) {
  EXPECT_EQ(rounding_of(roof(0.0)).step, 0.0);
  EXPECT_EQ(rounding_of(roof(0.005)).step, 0.0);
  EXPECT_EQ(rounding_of({}).step, 0.0);
  EXPECT_EQ(rounding_of(std::vector<Vec3>(50, Vec3(1.0, 2.0, 3.0))).step, 0.0);
  std::vector<Vec3> raster;
  for (int x = 0; x < 50; ++x) {
    for (int y = 0; y < 50; ++y) raster.emplace_back(x, y, 10.0 * std::sin(0.1 * x + 0.2 * y));
  }
  EXPECT_EQ(rounding_of(raster).step, 0.0);
}

TEST(Rounding, IsNoneOfFacesParallelToTheAxes) {
  std::vector<Vec3> cube;
  for (int x = 0; x <= 20; ++x) {
    for (int y = 0; y <= 20; ++y) {
      for (int z = 0; z <= 20; ++z) {
        const bool inside = x % 20 != 0 && y % 20 != 0 && z % 20 != 0;
        if (!inside) cube.push_back(0.05 * Vec3(x, y, z));
      }
    }
  }
  EXPECT_EQ(rounding_of(cube).step, 0.0);
}

TEST(Rounding, IsSpreadOverOneStepAndLeavesCopiesCopies) {
  std::vector<Vec3> positions = roof(kStep);
  positions.push_back(positions[5]);
  positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  const Rounding found = rounding_of(positions);
  const std::vector<Vec3> moved = spread(positions, found);
  EXPECT_EQ(moved[10000], moved[5]);
  EXPECT_TRUE(std::isnan(moved[10001].x()));
  Vec3 mean = Vec3::Zero(), squares = Vec3::Zero();
  for (std::size_t i = 0; i < 10000; ++i) {
    const Vec3 part = (moved[i] - positions[i]) / kStep;
    ASSERT_LE(part.cwiseAbs().maxCoeff(), 0.5 + 1e-9);
    mean += part / 10000.0;
    squares += part.cwiseProduct(part) / 10000.0;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((squares - Vec3::Constant(1.0 / 12.0)).cwiseAbs().maxCoeff(), 0.004);
}

TEST(Rounding, IsSpreadBeforeNormalsAreEstimated) {
  PointCloud cloud;
  cloud.positions = roof(kStep);
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_NEAR(prepared.decision.rounding.step, kStep, 1e-12);
  EXPECT_FALSE(prepared.decision.exact);
  EXPECT_EQ(prepared.positions.data(), prepared.moved.data());
  ASSERT_EQ(prepared.notes.size(), 2u);
  EXPECT_NE(prepared.notes[0].find("rounded to 0.05, about 0.46 of the spacing"), std::string::npos)
      << prepared.notes[0];
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    const double across = p.x() + 0.3 * p.y();
    if (std::abs(across) < 0.4) continue;
    const Vec3 normal = Vec3(across > 0.0 ? 0.4 : -0.4, across > 0.0 ? 0.12 : -0.12, 1.0);
    wrong += prepared.normals[i].dot(normal.normalized()) < std::cos(0.35) ? 1 : 0;
  }
  EXPECT_LT(wrong, 500u);

  cloud.normals = prepared.made;
  EXPECT_TRUE(prepare(cloud).moved.empty());
}

TEST(Rounding, IsTheSameForAnyOrderAndNumberOfThreads) {
  const std::vector<Vec3> positions = roof(kStep);
  const std::vector<Vec3> moved = spread(positions, rounding_of(positions));
  set_thread_count(1);
  EXPECT_EQ(spread(positions, rounding_of(positions)), moved);
  set_thread_count(0);
  const std::vector<Vec3> reversed(positions.rbegin(), positions.rend());
  std::vector<Vec3> back = spread(reversed, rounding_of(reversed));
  EXPECT_EQ(std::vector<Vec3>(back.rbegin(), back.rend()), moved);
}

}  // namespace
}  // namespace pcednet::detect
