#include "workbench/classic/edge_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "support/expect_error.h"

namespace pcednet::classic {
namespace {

/// Points on the faces x = 0 and y = 0 of a right angle, whose edge is the z axis.
std::vector<Vec3> corner_points(std::size_t count) {
  Random random(3);
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const double along = random.uniform(), up = random.uniform();
    positions.push_back(i % 2 ? Vec3(along, 0, up) : Vec3(0, along, up));
  }
  return positions;
}

TEST(SurfaceVariation, IsThatOfKnownNeighbourhoods) {
  // The corners of a box of 2a x 2b x 2c: variances a^2, b^2, c^2.
  std::vector<Vec3> box;
  for (int i = 0; i < 8; ++i) {
    box.emplace_back(i & 1 ? 3.0 : -3.0, i & 2 ? 2.0 : -2.0, i & 4 ? 1.0 : -1.0);
  }
  for (const double v : surface_variation(box, 8)) EXPECT_NEAR(v, 1.0 / 14.0, 1e-14);
  std::vector<Vec3> plane;
  for (int i = 0; i < 100; ++i) plane.emplace_back(i % 10, i / 10, 0.3 * (i % 10));
  for (const double v : surface_variation(plane, 9)) EXPECT_NEAR(v, 0.0, 1e-14);
}

TEST(SurfaceVariation, AnswersForEveryInput) {
  std::vector<Vec3> positions(20, Vec3(1, 2, 3));
  for (const double v : surface_variation(positions, 10)) EXPECT_EQ(v, 0.0);
  positions[4].x() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(surface_variation(positions, 10)[4]));
  EXPECT_ERROR(ErrorKind::kUsage, surface_variation(positions, 3));
  EXPECT_ERROR(ErrorKind::kInsufficient, surface_variation(positions, 30));
  EXPECT_ERROR(ErrorKind::kInsufficient, surface_variation({}, 10));
}

TEST(CovarianceAnalysis, PutsItsThresholdAtMultiplesOfTheDeviation) {
  const auto positions = corner_points(500);
  const EdgeMeasure measure = covariance_analysis(positions, {.threshold = 0.5});
  double mean = 0.0, square = 0.0;
  for (const double v : measure.values) mean += v / 500, square += v * v / 500;
  EXPECT_NEAR(measure.threshold, std::sqrt(square - mean * mean), 1e-12);
}

TEST(CovarianceAnalysis, FindsARightAngle) {
  const auto positions = corner_points(4000);
  for (const EdgeMeasure& measure :
       {covariance_analysis(positions), multi_scale_variation(positions)}) {
    std::size_t near = 0, found = 0, wrong = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double away = std::max(positions[i].x(), positions[i].y());
      const bool edge = measure.values[i] > measure.threshold;
      if (away < 0.01) ++near, found += edge;
      if (away > 0.2) wrong += edge;
    }
    EXPECT_GT(found, near * 8 / 10);
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(CovarianceAnalysis, IsTheSameForAnyThreadsOrderAndPlace) {
  const auto positions = corner_points(1000);
  set_thread_count(1);
  const EdgeMeasure one = covariance_analysis(positions);
  set_thread_count(8);
  std::vector<Vec3> reversed(positions.rbegin(), positions.rend());
  EdgeMeasure eight = covariance_analysis(reversed);
  std::reverse(eight.values.begin(), eight.values.end());
  EXPECT_EQ(one.values, eight.values);
  EXPECT_EQ(one.threshold, eight.threshold);
  for (Vec3& p : reversed) p += Vec3(524288, 4194304, 0);  // exact for these
  const EdgeMeasure moved = covariance_analysis(reversed);
  set_thread_count(0);
  EXPECT_NEAR(moved.threshold, one.threshold, 1e-6);
}

}  // namespace
}  // namespace pcednet::classic
