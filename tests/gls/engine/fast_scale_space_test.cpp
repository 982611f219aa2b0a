#include "pcednet/gls/engine/fast_scale_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "gls/engine/fast_clouds.h"
#include "gls/variants.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "support/expect_error.h"

namespace pcednet::gls {
namespace {

const test::Variant kFastVariants[] = {{"Sphere", Reconstruction::kSphere, {}},
                                       {"Gated", Reconstruction::kSphere, 0.1},
                                       {"Projected", Reconstruction::kSphereMls, {}},
                                       {"GatedAndProjected", Reconstruction::kSphereMls, -0.2}};

class FastScaleSpaceInvariance : public testing::TestWithParam<test::Variant> {};

TEST_P(FastScaleSpaceInvariance, SameBitsForAnyNumbering) {
  const test::Cloud cloud = test::awkward_cloud(6000);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kAll28);
  const FastScaleSpace space(cloud.points(), options);
  const auto expected = test::describe(space, test::all_targets(cloud.positions.size()));
  auto order = test::all_targets(cloud.positions.size());
  test::Stream stream(5);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[stream.next() % i]);
  test::Cloud shuffled;
  for (const std::uint32_t i : order) shuffled.add(cloud.positions[i], cloud.normals[i]);
  std::vector<std::uint32_t> back(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) back[order[i]] = i;
  const FastScaleSpace other(shuffled.points(), options);
  EXPECT_EQ(space.scales(), other.scales());
  test::expect_same_bits(expected, test::describe(other, back));
}

TEST_P(FastScaleSpaceInvariance, SameBitsForPointsThatAreEqual) {
  // A pile that fills groups and blocks, and twins that end up in different ones.
  test::Cloud cloud = test::cube(6000, 23, 0.005, 0.2);
  for (std::size_t i = 0; i < 6000; i += 3) cloud.add(cloud.positions[i], cloud.normals[i]);
  for (int i = 0; i < 5000; ++i) cloud.add(cloud.positions[1], cloud.normals[1]);
  ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kInvariant7);
  options.range.s_min = 0.02;
  const auto matrix = test::describe(FastScaleSpace(cloud.points(), options),
                                     test::all_targets(cloud.positions.size()));
  const std::size_t row = matrix.scales * matrix.width;
  const auto expect_same = [&](std::size_t i, std::size_t j) {
    EXPECT_EQ(
        std::memcmp(&matrix.features[i * row], &matrix.features[j * row], row * sizeof(float)), 0)
        << i << " and " << j;
  };
  for (std::size_t i = 0; i < 2000; ++i) expect_same(3 * i, 6000 + i);
  for (std::size_t i = 8000; i < 13000; ++i) expect_same(1, i);
}

TEST_P(FastScaleSpaceInvariance, SameBitsOnAnyNumberOfThreads) {
  const test::Cloud cloud = test::awkward_cloud(6000);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kPaper6);
  const auto targets = test::all_targets(cloud.positions.size());
  set_thread_count(1);
  const auto one = test::describe(FastScaleSpace(cloud.points(), options), targets);
  set_thread_count(5);
  const auto five = test::describe(FastScaleSpace(cloud.points(), options), targets);
  set_thread_count(0);
  test::expect_same_bits(one, five);
}

TEST_P(FastScaleSpaceInvariance, SameBitsForAnyChoiceOfTargets) {
  const test::Cloud cloud = test::awkward_cloud(6000);
  const FastScaleSpace space(cloud.points(), test::options_of(GetParam(), FeatureSet::kPaper6));
  const auto all = test::describe(space, test::all_targets(cloud.positions.size()));
  const std::vector<std::uint32_t> some = {4000, 17, 60, 5999, 17, 2345};
  const auto few = test::describe(space, some);
  const std::size_t row = all.scales * all.width;
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_TRUE(std::equal(few.features.begin() + static_cast<std::ptrdiff_t>(i * row),
                           few.features.begin() + static_cast<std::ptrdiff_t>((i + 1) * row),
                           all.features.begin() + static_cast<std::ptrdiff_t>(some[i] * row)));
    EXPECT_EQ(few.status_at(i, 0), all.status_at(some[i], 0));
  }
}

TEST_P(FastScaleSpaceInvariance, TurningTheNormalsNegatesAllButPhi) {
  test::Cloud cloud = test::awkward_cloud(6000);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kInvariant7);
  const auto targets = test::all_targets(cloud.positions.size());
  const auto before = test::describe(FastScaleSpace(cloud.points(), options), targets);
  for (Vec3& n : cloud.normals) n = -n;
  const auto after = test::describe(FastScaleSpace(cloud.points(), options), targets);
  EXPECT_EQ(before.status, after.status);
  for (std::size_t i = 0; i < before.features.size(); ++i) {
    const float sign = i % 7 == 5 ? 1.0f : -1.0f;
    ASSERT_EQ(before.features[i], sign * after.features[i]) << i % 7;
  }
}

TEST_P(FastScaleSpaceInvariance, StaysTheSameFarFromTheOrigin) {
  // Coordinates on a grid of 2^-20 stay exact a million away, so that only the arithmetic can tell.
  test::Cloud cloud = test::awkward_cloud(6000);
  for (Vec3& p : cloud.positions) p = (p * 0x1p20).array().round().matrix() * 0x1p-20;
  ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kInvariant7);
  const auto targets = test::all_targets(cloud.positions.size());
  const auto before = test::describe(FastScaleSpace(cloud.points(), options), targets);
  for (Vec3& p : cloud.positions) p += Vec3(0x1p20, -0x1p20, 0x1p19);
  const auto after = test::describe(FastScaleSpace(cloud.points(), options), targets);
  EXPECT_EQ(before.status, after.status);
  std::vector<float> differences;
  for (std::size_t i = 0; i < before.features.size(); ++i) {
    differences.push_back(std::abs(before.features[i] - after.features[i]));
  }
  // Mean positions are rounded to 2^-33 there; a source at the rim may come or go.
  std::sort(differences.begin(), differences.end());
  EXPECT_LE(differences[differences.size() / 2], 1e-6f);
  EXPECT_LE(differences[differences.size() * 999 / 1000], 1e-4f);
}

INSTANTIATE_TEST_SUITE_P(Variants, FastScaleSpaceInvariance, testing::ValuesIn(kFastVariants),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(FastScaleSpace, AgreesBetweenVectorCodes) {
  const test::Cloud cloud = test::awkward_cloud(6000);
  for (const test::Variant& variant : kFastVariants) {
    const ScaleSpaceOptions options = test::options_of(variant, FeatureSet::kInvariant7);
    const auto targets = test::all_targets(cloud.positions.size());
    const auto expected = test::describe(
        FastScaleSpace(cloud.points(), options, all_lane_kernels().front()), targets);
    for (const LaneKernels& kernels : all_lane_kernels()) {
      const auto found = test::describe(FastScaleSpace(cloud.points(), options, kernels), targets);
      EXPECT_EQ(found.status, expected.status) << kernels.name;
      std::vector<float> differences;
      for (std::size_t i = 0; i < found.features.size(); ++i) {
        const float size = std::max(1.0f, std::abs(expected.features[i]));
        differences.push_back(std::abs(found.features[i] - expected.features[i]) / size);
      }
      std::sort(differences.begin(), differences.end());
      EXPECT_LE(differences[differences.size() / 2], 1e-6f) << kernels.name;
      EXPECT_LE(differences[differences.size() * 999 / 1000], 1e-3f) << kernels.name;
    }
  }
}

TEST(FastScaleSpace, GivesTheStatusesOfTheExactEngineOnAGrid) {
  // Points on a grid lie at exactly the support radius again and again.
  test::Cloud cloud;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) cloud.add(Vec3(i, j, 0) / 8.0, Vec3::UnitZ());
  }
  for (const std::optional<double> gate : {std::optional<double>(), std::optional<double>(0.1)}) {
    ScaleSpaceOptions options;
    options.scales = 4;
    options.side_gate = gate;
    options.range.s_min = 0.125, options.range.s_max = 1.0;  // radii 0.125, 0.25, 0.5, 1
    const auto targets = test::all_targets(3600);
    const auto fast = test::describe(FastScaleSpace(cloud.points(), options), targets);
    const auto exact = test::describe(ExactScaleSpace(cloud.points(), options), targets);
    EXPECT_EQ(fast.status, exact.status);
    EXPECT_EQ(fast.status_at(61, 0), FitStatus::kUndefined);  // its 4 neighbours are not closer
  }
}

TEST(FastScaleSpace, AgreesWithTheExactEngineOnDegenerateFits) {
  // Cancelling normals, a line, piles: what float cannot tell must come out as in double.
  const auto [cloud, first] = test::cube_with_piles();
  for (const test::Variant& variant : kFastVariants) {
    ScaleSpaceOptions options = test::options_of(variant, FeatureSet::kInvariant7);
    const FastScaleSpace fast(cloud.points(), options);
    const ExactScaleSpace exact(cloud.points(), options);
    std::vector<std::uint32_t> targets;
    for (std::uint32_t i = first; i < cloud.positions.size(); ++i) targets.push_back(i);
    const auto f = test::describe(fast, targets);
    const auto e = test::describe(exact, targets);
    EXPECT_EQ(f.status, e.status) << variant.name;
    for (std::size_t i = 0; i < f.features.size(); ++i) {
      ASSERT_NEAR(f.features[i], e.features[i], 1e-5) << variant.name << " " << i % 7;
    }
  }
}

TEST(FastScaleSpace, CostsNoMoreWhereThousandsOfPointsAreOne) {
  // Quadratic work would take minutes.
  test::Cloud cloud = test::cube(30000, 3);
  for (int i = 0; i < 60000; ++i) cloud.add(Vec3(0.5, 0.1, 0.2), Vec3::UnitX());
  ScaleSpaceOptions options;
  options.range.s_min = 0.03;
  const FastScaleSpace space(cloud.points(), options);
  const auto matrix = test::describe(space, test::all_targets(cloud.positions.size()));
  for (const float f : matrix.features) ASSERT_TRUE(std::isfinite(f));
  EXPECT_EQ(matrix.status_at(60000, 0), FitStatus::kStable);
}

TEST(FastScaleSpace, CountsCopiesOnce) {
  test::Cloud cloud = test::cube(9000, 3, 0.01, 0.2);
  ScaleSpaceOptions options;
  options.side_gate = -0.3;
  const auto targets = test::all_targets(9000);
  const auto wanted = test::describe(FastScaleSpace(cloud.points(), options), targets);
  const auto exact = test::describe(ExactScaleSpace(cloud.points(), options), targets);
  for (std::size_t i = 0; i < 9000; ++i) {
    for (std::size_t copy = 0; copy < (i == 77 ? 5000 : i % 3); ++copy) {
      cloud.add(cloud.positions[i], cloud.normals[i]);
    }
  }
  const auto found = test::describe(FastScaleSpace(cloud.points(), options), targets);
  EXPECT_EQ(found.status, wanted.status);
  for (std::size_t i = 0; i < found.features.size(); ++i) {
    ASSERT_NEAR(found.features[i], wanted.features[i],
                1e-5f * (1.0f + std::abs(wanted.features[i])));
  }
  EXPECT_EQ(test::describe(ExactScaleSpace(cloud.points(), options), targets).features,
            exact.features);
}

TEST(FastScaleSpace, RefusesWhatItCannotDescribe) {
  const test::Cloud cube = test::cube(1000, 1);
  const auto kind = [&](const ScaleSpaceOptions& options) {
    try {
      FastScaleSpace(cube.points(), options);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::kFailure;
  };
  ScaleSpaceOptions options;
  options.reconstruction = Reconstruction::kPlaneMls;
  EXPECT_EQ(kind(options), ErrorKind::kUsage);
  for (const double eps : {0.0, -1.0, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    options = {};
    options.eps = eps;
    EXPECT_EQ(kind(options), ErrorKind::kUsage);
  }
  EXPECT_ERROR(ErrorKind::kInsufficient, FastScaleSpace({}, {}));
  const FastScaleSpace space(cube.points(), {});
  std::vector<float> out(16 * 6);
  std::vector<FitStatus> status(16);
  const std::vector<std::uint32_t> beyond = {1000}, two = {1, 2};
  EXPECT_ERROR(ErrorKind::kUsage, space.describe(beyond, out, status));
  EXPECT_ERROR(ErrorKind::kUsage, space.describe(two, out, status));
}

TEST(FastScaleSpace, StopsWhenToldTo) {
  const test::Cloud cube = test::cube(1000, 1);
  Progress progress;
  progress.cancelled = [] { return true; };
  EXPECT_ERROR(ErrorKind::kCancelled, FastScaleSpace(cube.points(), {}, &progress));
  const FastScaleSpace space(cube.points(), {});
  std::vector<float> out(1000 * 16 * 6);
  std::vector<FitStatus> status(1000 * 16);
  EXPECT_ERROR(ErrorKind::kCancelled,
               space.describe(test::all_targets(1000), out, status, &progress));
}

}  // namespace
}  // namespace pcednet::gls
