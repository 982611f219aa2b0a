#include "pcednet/gls/scales.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "gls/test_clouds.h"
#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/gls/engine/fast_scale_space.h"
#include "pcednet/gls/exact_scale_space.h"
#include "pcednet/spatial/curve_order.h"
#include "support/expect_error.h"

namespace pcednet::gls {
namespace {

ScaleRange range_of(const std::vector<Vec3>& positions, const ScaleRange& given) {
  return scale_range(positions, given, [&] {
    return spacings_of_places(positions, spatial::curve_order(positions));
  });
}

TEST(Scales, SmallestIsTheMeanDistanceToTenNeighbours) {
  const auto cloud = test::cube(3000, 4, 0.01, 0.1);
  double sum = 0.0;
  for (const Vec3& p : cloud.positions) {
    std::vector<double> distances;
    for (const Vec3& q : cloud.positions) distances.push_back((p - q).norm());
    std::partial_sort(distances.begin(), distances.begin() + 11, distances.end());
    sum += std::accumulate(distances.begin() + 1, distances.begin() + 11, 0.0) / 10;
  }
  const auto range = range_of(cloud.positions, {});
  EXPECT_NEAR(range.s_min / (sum / 3000), 1.0, 1e-13);
  // The cube with noise at its corners: between 1 and 1.1 times its own diagonal.
  EXPECT_GT(range.s_max, 0.1 * std::sqrt(3.0));
  EXPECT_LT(range.s_max, 0.11 * std::sqrt(3.0));
}

TEST(Scales, AreSampledEvenlyInTheLogarithm) {
  const auto scales = sample_scales({0.5, 4.0}, 4);
  ASSERT_EQ(scales.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(scales[i], std::ldexp(0.5, int(i)), 1e-15);
  for (const int count : {4, 8, 16, 32, 64, 128}) {
    const auto many = sample_scales({0.1, 1.7}, count);
    EXPECT_EQ(many.size(), static_cast<std::size_t>(count));
    EXPECT_DOUBLE_EQ(many.front(), 0.1);
    EXPECT_DOUBLE_EQ(many.back(), 1.7);
    EXPECT_TRUE(std::is_sorted(many.begin(), many.end()));
  }
}

TEST(Scales, RefuseCountsThatAreNotPowersOfTwo) {
  for (const int count : {-4, 0, 1, 2, 3, 12, 17, 256}) {
    EXPECT_ERROR(ErrorKind::kUsage, sample_scales({0.1, 1.0}, count)) << count;
  }
  EXPECT_ERROR(ErrorKind::kUsage, sample_scales({1.0, 1.0}, 16));
  EXPECT_ERROR(ErrorKind::kUsage, sample_scales({0.0, 1.0}, 16));
}

TEST(Scales, RefuseCloudsInOnePlace) {
  const Vec3 p(1, 2, 3);
  EXPECT_ERROR(ErrorKind::kInsufficient, range_of({}, {}));
  EXPECT_ERROR(ErrorKind::kInsufficient, range_of({p}, {}));
  EXPECT_ERROR(ErrorKind::kInsufficient, range_of(std::vector<Vec3>(50, p), {}));
  EXPECT_ERROR(ErrorKind::kInsufficient, range_of({p}, {0.1, 0.0}));
}

TEST(Scales, OfLengthsThatCannotBeDescribedAreSaidToBe) {
  for (const double size : {1e-100, 1e-102, 1e101}) {
    auto cloud = test::cube(1000, 1);
    for (Vec3& p : cloud.positions) p *= size;
    const auto error = pcednet::test::error_of([&] { range_of(cloud.positions, {}); });
    ASSERT_TRUE(error) << size;
    EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
    EXPECT_NE(std::string(error->what()).find("lengths from 1e-100 to 1e100"), std::string::npos);
  }
}

TEST(Scales, ReachTwiceTheSpacingOfSparseClouds) {
  const std::vector<Vec3> two = {Vec3(1, 2, 3), Vec3(1, 2, 5)};
  const auto range = range_of(two, {});
  EXPECT_EQ(range.s_min, 2.0);
  EXPECT_EQ(range.s_max, 4.0);
  const auto cloud = test::cube(1000, 1);
  const auto given = range_of(cloud.positions, {0.5, 0.0});
  EXPECT_EQ(given.s_min, 0.5);
  EXPECT_EQ(given.s_max, 1.0);
}

TEST(Scales, AreThePapersWhereverItHasSome) {
  // At the border between the two rules: the paper's s_max just above and just below s_min.
  const auto cloud = test::cube(1000, 1);
  const double s_min = range_of(cloud.positions, {}).s_min;
  const double diagonal = range_of(cloud.positions, {0.0, 0.0, 1.0}).s_max;
  const double border = s_min / diagonal;
  EXPECT_NEAR(range_of(cloud.positions, {0.0, 0.0, 1.01 * border}).s_max, 1.01 * s_min, 1e-12);
  EXPECT_EQ(range_of(cloud.positions, {0.0, 0.0, 0.99 * border}).s_max, 2.0 * s_min);
}

TEST(Scales, AreThoseOfOnePointAtEachPlace) {
  constexpr ScaleRange kTenfold = {.s_max_ratio = 10.0};
  const auto cloud = test::cube(3000, 1);
  ScaleSpaceOptions options;
  options.range.s_max_ratio = 10.0;
  const FastScaleSpace fast({cloud.positions, cloud.normals}, options);
  for (const std::size_t copies : {1u, 700u, 3000u, 33000u}) {
    test::Cloud with = cloud;
    for (std::size_t i = 0; i < copies; ++i) {
      with.positions.push_back(cloud.positions[i % 3000]);
      with.normals.push_back(i % 5 == 0 ? Vec3::UnitX() : cloud.normals[i % 3000]);
    }
    for (const ScaleRange& given : {kTenfold, ScaleRange{}}) {
      const ScaleRange one = range_of(cloud.positions, given),
                       many = range_of(with.positions, given);
      EXPECT_EQ(many.s_min, one.s_min);
      EXPECT_EQ(many.s_max, one.s_max);
    }
    const auto scales = FastScaleSpace({with.positions, with.normals}, options).scales();
    for (std::size_t i = 0; i < scales.size(); ++i) {
      EXPECT_NEAR(scales[i] / fast.scales()[i], 1.0, 1e-12);
    }
    EXPECT_EQ(ExactScaleSpace({with.positions, with.normals}, options).scales().front(),
              range_of(with.positions, kTenfold).s_min);
  }
}

TEST(Scales, OfARatioFollowTheSpacingAlone) {
  constexpr ScaleRange kTenfold = {.s_max_ratio = 10.0};
  const auto cloud = test::cube(3600, 1);
  const auto whole = range_of(cloud.positions, kTenfold);
  EXPECT_DOUBLE_EQ(whole.s_max, 10.0 * whole.s_min);

  std::vector<Vec3> side;
  for (const Vec3& p : cloud.positions) {
    if (p.z() > 0.0) side.push_back(p);
  }
  const auto half = range_of(side, kTenfold);
  EXPECT_EQ(half.s_min, whole.s_min);
  const auto given = range_of(side, {.s_min = 0.5, .s_max_ratio = 10.0});
  EXPECT_DOUBLE_EQ(given.s_max, 5.0);
  EXPECT_ERROR(ErrorKind::kUsage, range_of(side, {.s_max_ratio = 0.5}));
}

TEST(Scales, OfARatioBeginAtAPreferredNumber) {
  const auto s_min_of = [](double step, bool rounded = true) {
    std::vector<Vec3> grid;
    for (int i = 0; i < 2500; ++i) grid.emplace_back(step * (i % 50), step * (i / 50), 0.0);
    return range_of(grid, {.s_max_ratio = 10.0, .rounded = rounded}).s_min;
  };
  EXPECT_NEAR(s_min_of(1.0, false), (4.0 + 4.0 * std::sqrt(2.0) + 4.0) / 10.0, 1e-12);
  EXPECT_EQ(s_min_of(1.0), 1.4);
  EXPECT_EQ(s_min_of(1.05), 1.4);
  EXPECT_EQ(s_min_of(1.1), 1.6);
  EXPECT_EQ(s_min_of(0.7), 1.0);
  EXPECT_EQ(s_min_of(0.72), 1.0);
  EXPECT_EQ(s_min_of(0.00001), 0.000014);
  EXPECT_EQ(s_min_of(720000.0), 1000000.0);
}

TEST(Scales, OfARatioAreNotMovedByAThrownPoint) {
  constexpr ScaleRange kTenfold = {.s_max_ratio = 10.0};
  auto positions = test::cube(4000, 1).positions;
  const double s_min = range_of(positions, kTenfold).s_min;
  const double mean = range_of(positions, {}).s_min;
  positions.emplace_back(1000.0, 0.0, 0.0);
  EXPECT_NEAR(range_of(positions, kTenfold).s_min / s_min, 1.0, 0.001);
  EXPECT_GT(range_of(positions, {}).s_min / mean, 2.0);
}

/// A plane seen from the origin: the spacing grows with the range, `reach` times in all.
std::vector<Vec3> fan(double reach) {
  Random random(9);
  std::vector<Vec3> positions;
  for (int i = 0; i < 4000; ++i) {
    const double range = std::pow(reach, random.uniform()), angle = random.uniform(0.0, 6.283);
    positions.emplace_back(range * std::cos(angle), range * std::sin(angle), 0.0);
  }
  return positions;
}

TEST(Scales, OfARatioHaveOctavesWhereTheSpacingVaries) {
  const auto reach_of = [](double reach, bool octaves) {
    const auto range = range_of(fan(reach), {.s_max_ratio = 10.0, .octaves = octaves});
    return range.s_max / range.s_min;
  };
  // The quartiles of the spacing are sqrt(6) apart, but for the randomness of the points.
  EXPECT_DOUBLE_EQ(reach_of(6.0, true), 80.0);
  EXPECT_DOUBLE_EQ(reach_of(6.0, false), 10.0);
  EXPECT_DOUBLE_EQ(reach_of(1.5, true), 10.0);
}

TEST(Scales, HaveTheOctavesThatEndAtTheLargest) {
  const auto count = [](double s_max, double ratio = 8.0) {
    return octave_count({.s_min = 0.1, .s_max = s_max, .s_max_ratio = ratio, .octaves = true});
  };
  EXPECT_EQ(count(0.8), 1u);
  EXPECT_EQ(count(1.5), 1u);
  EXPECT_EQ(count(1.6), 2u);
  EXPECT_EQ(count(6.39), 3u);
  EXPECT_EQ(count(100.0), kOctaves);
  EXPECT_EQ(count(100.0, 0.0), 1u);
  EXPECT_EQ(octave_count({.s_min = 0.1, .s_max = 6.4, .s_max_ratio = 8.0}), 1u);
  const ScaleRange whole = {.s_min = 0.1, .s_max = 6.4, .s_max_ratio = 8.0, .octaves = true};
  EXPECT_DOUBLE_EQ(at_octave(whole, 2).s_min, 0.4);
  EXPECT_DOUBLE_EQ(at_octave(whole, 2).s_max, 3.2);
  EXPECT_EQ(at_octave({.s_min = 0.1, .s_max = 1.5, .s_max_ratio = 8.0}, 0).s_max, 1.5);
  EXPECT_DOUBLE_EQ(sample_scales(whole, 8).back(), 0.8);
  EXPECT_DOUBLE_EQ(sample_scales({.s_min = 0.1, .s_max = 1.5, .s_max_ratio = 8.0}, 8).back(), 1.5);
}

TEST(Scales, AreTheSameFromBothEngines) {
  const auto sparse = test::cube(60, 2);
  test::Cloud copies;
  for (int copy = 0; copy < 12; ++copy) {
    for (std::size_t i = 0; i < sparse.positions.size(); ++i) {
      copies.positions.push_back(sparse.positions[i]);
      copies.normals.push_back(sparse.normals[i]);
    }
  }
  for (const auto& cloud : {sparse, copies}) {
    const OrientedPoints points{cloud.positions, cloud.normals};
    const ExactScaleSpace exact(points, {});
    const FastScaleSpace fast(points, {});
    EXPECT_NEAR(exact.scales().back() / exact.scales().front(), 2.0, 1e-12);
    for (std::size_t s = 0; s < exact.scales().size(); ++s) {
      EXPECT_NEAR(fast.scales()[s] / exact.scales()[s], 1.0, 1e-6);
    }
    EXPECT_NE(note_on({}, fast.scales(), cloud.positions), "");
    ScaleSpaceOptions given;
    given.range.s_max = 1.0;
    EXPECT_EQ(note_on(given, fast.scales(), cloud.positions), "");
  }
  const auto dense = test::cube(2000, 2);
  const FastScaleSpace fast({dense.positions, dense.normals}, {});
  EXPECT_EQ(note_on({}, fast.scales(), dense.positions), "");
}

TEST(Scales, KeepGivenBoundsAndRefuseImpossibleOnes) {
  const auto cloud = test::cube(1000, 1);
  const auto range = range_of(cloud.positions, {0.05, 0.0});
  EXPECT_EQ(range.s_min, 0.05);
  EXPECT_NEAR(range.s_max, 0.1 * std::sqrt(3.0), 1e-3);
  EXPECT_EQ(range_of(cloud.positions, {0.0, 0.7}).s_max, 0.7);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ScaleRange& bad : {ScaleRange{-1, 0}, ScaleRange{0, -1}, ScaleRange{nan, 0},
                                ScaleRange{0, 1 / 0.0}, ScaleRange{0.5, 0.5}, ScaleRange{2, 1}}) {
    EXPECT_ERROR(ErrorKind::kUsage, range_of(cloud.positions, bad));
  }
  EXPECT_ERROR(ErrorKind::kUsage, range_of(cloud.positions, {0, 1e-5}));
  const auto error = pcednet::test::error_of([&] { range_of(cloud.positions, {0.1 + 0.2, 0.1}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(std::string(error->what()).find("no scales from 0.3 to 0.1: "), 0u) << error->what();
}

}  // namespace
}  // namespace pcednet::gls
