#include "pcednet/gls/exact_scale_space.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "gls/test_clouds.h"
#include "gls/variants.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "support/expect_error.h"

namespace pcednet::gls {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const test::Variant kVariants[] = {
    {"Sphere", Reconstruction::kSphere, {}},
    {"GatedSphere", Reconstruction::kSphere, 0.1},
    {"SphereMls", Reconstruction::kSphereMls, {}},
    {"GatedSphereMls", Reconstruction::kSphereMls, -0.2},
    {"CovariancePlane", Reconstruction::kCovariancePlane, {}},
    {"PlaneMls", Reconstruction::kPlaneMls, {}},
};

bool is_plane(const test::Variant& variant) {
  return variant.reconstruction == Reconstruction::kCovariancePlane ||
         variant.reconstruction == Reconstruction::kPlaneMls;
}

/// `tolerance` times the value where that is above 1.
void expect_near(const test::Matrix<double>& a, const test::Matrix<double>& b, double tolerance) {
  EXPECT_EQ(a.status, b.status);
  double worst = 0.0;
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    worst = std::max(
        worst, std::abs(a.features[i] - b.features[i]) / std::max(1.0, std::abs(a.features[i])));
  }
  EXPECT_LE(worst, tolerance);
}

class ExactScaleSpaceInvariance : public testing::TestWithParam<test::Variant> {};

TEST_P(ExactScaleSpaceInvariance, SameBitsForAnyNumbering) {
  const test::Cloud cloud = test::awkward_cloud(1500);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kAll28);
  const auto expected = test::describe(cloud, options);
  auto order = test::all_targets(cloud.positions.size());
  test::Stream stream(5);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[stream.next() % i]);
  test::Cloud shuffled;
  for (const std::uint32_t i : order) shuffled.add(cloud.positions[i], cloud.normals[i]);

  const ExactScaleSpace space(shuffled.points(), options);
  EXPECT_EQ(space.scales(), ExactScaleSpace(cloud.points(), options).scales());
  std::vector<std::uint32_t> back(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) back[order[i]] = i;
  test::expect_same_bits(expected, test::describe(space, back));
}

TEST_P(ExactScaleSpaceInvariance, SameBitsOnAnyNumberOfThreads) {
  const test::Cloud cloud = test::awkward_cloud(1500);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kPaper6);
  set_thread_count(1);
  const auto one = test::describe<float>(cloud, options);
  set_thread_count(5);
  const auto five = test::describe<float>(cloud, options);
  set_thread_count(0);
  test::expect_same_bits(one, five);
}

TEST_P(ExactScaleSpaceInvariance, TurningTheNormalsNegatesAllButPhi) {
  test::Cloud cloud = test::awkward_cloud(1500);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kInvariant7);
  const auto before = test::describe(cloud, options);
  for (Vec3& n : cloud.normals) n = -n;
  const auto after = test::describe(cloud, options);
  EXPECT_EQ(before.status, after.status);
  for (std::size_t i = 0; i < before.features.size(); ++i) {
    const double sign = i % 7 == 5 ? 1.0 : -1.0;
    ASSERT_EQ(before.features[i], sign * after.features[i]) << i % 7;
  }
}

TEST_P(ExactScaleSpaceInvariance, TurnsWithTheCloud) {
  test::Cloud cloud = test::awkward_cloud(1500);
  ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kInvariant7);
  options.range.s_min = 0.05, options.range.s_max = 0.2;  // the bounding box does not turn
  const auto before = test::describe(cloud, options);
  const Mat3 rotation = Eigen::AngleAxisd(0.7, Vec3(1, -2, 3).normalized()).toRotationMatrix();
  for (Vec3& p : cloud.positions) p = rotation * p;
  for (Vec3& n : cloud.normals) n = rotation * n;
  // Coordinates are rounded to 1e-16, 2e-15 of the smallest scale. That is made worse where all
  // that keeps three neighbours from being two is one at the rim, which weighs as little as one
  // likes: a plane's eigenvalues then nearly tie.
  expect_near(before, test::describe(cloud, options), is_plane(GetParam()) ? 1e-6 : 1e-8);
}

TEST_P(ExactScaleSpaceInvariance, SameBitsWhenMovedExactly) {
  // Coordinates on a grid of 2^-20 stay exact 2^24 away: a twin of a cloud in a national grid.
  test::Cloud cloud = test::awkward_cloud(1500);
  for (Vec3& p : cloud.positions) p = (p * 0x1p20).array().round().matrix() * 0x1p-20;
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kAll28);
  const auto before = test::describe(cloud, options);
  const bool moves_points = projects(GetParam().reconstruction);
  for (Vec3& p : cloud.positions) p += Vec3(0x1p24, -0x1p23, 0x1p22);
  const auto after = test::describe(cloud, options);
  // A projected point asks the tree from a place rounded to 2e-9: neighbours that near to the rim,
  // where weights are 1e-15, may come in another order.
  if (moves_points) {
    expect_near(before, after, 1e-8);
  } else {
    test::expect_same_bits(before, after);
  }
}

TEST_P(ExactScaleSpaceInvariance, HoldsTenMillionUnitsAway) {
  test::Cloud cloud = test::awkward_cloud(1500);
  ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kPaper6);
  options.range.s_min = 0.06, options.range.s_max = 0.2;
  const auto before = test::describe(cloud, options);
  for (Vec3& p : cloud.positions) p += Vec3(1e7, -1e7, 1e7);
  // The coordinates themselves are rounded to 1e-9, 2e-8 of the smallest scale; see above.
  expect_near(before, test::describe(cloud, options), is_plane(GetParam()) ? 1e-2 : 1e-4);
}

TEST_P(ExactScaleSpaceInvariance, IsFreeOfUnits) {
  test::Cloud cloud = test::awkward_cloud(1500);
  const ScaleSpaceOptions options = test::options_of(GetParam(), FeatureSet::kAll28);
  const auto before = test::describe(cloud, options);
  test::Cloud larger = cloud, tiny = cloud;
  for (Vec3& p : larger.positions) p *= 1000.0 / 3.0;
  expect_near(before, test::describe(larger, options), 1e-8);
  for (Vec3& p : tiny.positions) p *= 0x1p-40;
  test::expect_same_bits(before, test::describe(tiny, options));
}

TEST_P(ExactScaleSpaceInvariance, NeverLeavesANumberThatIsNotFinite) {
  const test::Cloud cloud = test::awkward_cloud(1500);
  const auto matrix =
      test::describe<float>(cloud, test::options_of(GetParam(), FeatureSet::kAll28));
  for (const float f : matrix.features) ASSERT_TRUE(std::isfinite(f));
  for (std::size_t i = 0; i < matrix.status.size(); ++i) {
    ASSERT_LE(matrix.status[i], FitStatus::kUndefined);
    if (matrix.status[i] != FitStatus::kUndefined) continue;
    for (std::size_t f = 0; f < 28; ++f) ASSERT_EQ(matrix.features[28 * i + f], 0.0f);
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, ExactScaleSpaceInvariance, testing::ValuesIn(kVariants),
                         [](const auto& variant) { return std::string(variant.param.name); });

TEST(ExactScaleSpace, SmallerFeatureSetsAreColumnsOfTheLargest) {
  const test::Cloud cloud = test::awkward_cloud(800);
  ScaleSpaceOptions options;
  options.features = FeatureSet::kAll28;
  const auto all = test::describe(cloud, options);
  const auto all_names = feature_names(FeatureSet::kAll28);
  ASSERT_EQ(all_names.size(), 28u);
  for (const auto& [set, count] :
       {std::pair(FeatureSet::kAll28, 28), std::pair(FeatureSet::kInvariant7, 7),
        std::pair(FeatureSet::kPaper6, 6), std::pair(FeatureSet::kSpatial4, 4),
        std::pair(FeatureSet::kRelief3, 3)}) {
    ASSERT_EQ(feature_count(set), count);
    options.features = set;
    const auto some = test::describe(cloud, options);
    EXPECT_EQ(some.status, all.status);
    for (std::size_t f = 0; f < some.width; ++f) {
      const auto place = std::find(all_names.begin(), all_names.end(), feature_names(set)[f]);
      ASSERT_NE(place, all_names.end());
      const auto column = static_cast<std::size_t>(place - all_names.begin());
      for (std::size_t i = 0; i < all.status.size(); ++i) {
        ASSERT_EQ(some.features[i * some.width + f], all.features[i * 28 + column]);
      }
    }
  }
}

TEST(ExactScaleSpace, GivesOnePointTheSameRowAloneAndAmongOthers) {
  const test::Cloud cloud = test::awkward_cloud(800);
  const ExactScaleSpace space(cloud.points(), {});
  const auto all = test::describe(space, test::all_targets(cloud.positions.size()));
  const std::vector<std::uint32_t> some = {700, 3, 3, 250};
  const auto rows = test::describe(space, some);
  for (std::size_t r = 0; r < some.size(); ++r) {
    for (std::size_t s = 0; s < 16; ++s) {
      EXPECT_EQ(rows.status_at(r, s), all.status_at(some[r], s));
      for (std::size_t f = 0; f < 6; ++f) EXPECT_EQ(rows(r, s, f), all(some[r], s, f));
    }
  }
}

/// A flat square with normals up, and above its middle one point of unusable normal.
test::Cloud square_with_a_point_above(double height) {
  test::Cloud cloud;
  test::Stream stream(1);
  cloud.add({0.5, 0.5, height}, Vec3::Zero());
  for (int i = 0; i < 2000; ++i) cloud.add({stream.uniform(), stream.uniform(), 0}, Vec3::UnitZ());
  return cloud;
}

TEST(ExactScaleSpace, DescribesAPointOfUnusableNormalByItsNeighbours) {
  for (const test::Variant& variant : kVariants) {
    const test::Cloud cloud = square_with_a_point_above(0.02);
    ScaleSpaceOptions options = test::options_of(variant, FeatureSet::kInvariant7);
    options.range.s_min = 0.05;
    const ExactScaleSpace space(cloud.points(), options);
    const auto matrix = test::describe(space, {0});
    for (std::size_t s = 0; s < 16; ++s) {
      EXPECT_EQ(matrix.status_at(0, s), FitStatus::kStable);
      // The plane is found to 1e-15 from weights that sum to 5 and more; its height over t is kept
      // through projection. Curvatures are 1e-16 over a spread of 0.1.
      EXPECT_NEAR(matrix(0, s, 0) * space.scales()[s], 0.02, 1e-14) << variant.name;
      for (const std::size_t zero : {1, 2, 3, 4, 5, 6}) {
        EXPECT_NEAR(matrix(0, s, zero), 0.0, 1e-12) << variant.name << " " << zero;
      }
    }
  }
}

TEST(ExactScaleSpace, FindsTheAlgebraicDistanceToASphere) {
  for (const auto reconstruction : {Reconstruction::kSphere, Reconstruction::kSphereMls}) {
    test::Cloud cloud = test::sphere(4000, 3);
    const double height = 0.05, radius = 2.0;
    const Vec3 centre(10, -5, 3), out = Vec3(2, 3, -6) / 7;
    cloud.add(centre + (radius + height) * out, Vec3::Zero());
    ScaleSpaceOptions options;
    options.features = FeatureSet::kInvariant7;
    options.reconstruction = reconstruction;
    options.range.s_min = 0.3;
    const ExactScaleSpace space(cloud.points(), options);
    const auto matrix = test::describe(space, {4000});
    for (std::size_t s = 0; s < 16; ++s) {
      const double t = space.scales()[s];
      // Normalised S is (|p - c|^2 - R^2) / 2R. Coordinates of magnitude 10 are rounded to 2e-15.
      EXPECT_NEAR(matrix(0, s, 0) * t, height + height * height / (2 * radius), 1e-13);
      EXPECT_NEAR(matrix(0, s, 1), t / radius, 1e-12);
      // Level sets through the point, or the sphere itself once it is projected.
      const double at = projects(reconstruction) ? radius : radius + height;
      EXPECT_NEAR(matrix(0, s, 2), t / at, 1e-11);
      EXPECT_NEAR(matrix(0, s, 6), t / at, 1e-11);
      for (const std::size_t zero : {3, 4, 5}) EXPECT_NEAR(matrix(0, s, zero), 0.0, 1e-10);
    }
  }
}

TEST(ExactScaleSpace, MoreProjectionChangesNothingOnceThere) {
  // On a noisy sphere a few steps reach the surface; after that neither the number of steps allowed
  // nor the last step, shorter than a hundredth of t, matters much.
  test::Cloud cloud = test::sphere(3000, 9);
  test::Stream stream(10);
  for (Vec3& p : cloud.positions) p += 0.02 * stream.normal3();
  ScaleSpaceOptions options;
  options.reconstruction = Reconstruction::kSphereMls;
  options.range.s_min = 0.5;
  options.max_projection_steps = 50;
  const auto fifty = test::describe(cloud, options);
  options.max_projection_steps = 8;
  const auto eight = test::describe(cloud, options);
  EXPECT_EQ(fifty.features, eight.features);
  options.max_projection_steps = 0;
  const auto none = test::describe(cloud, options);
  options.reconstruction = Reconstruction::kSphere;
  EXPECT_EQ(test::describe(cloud, options).features, none.features);
}

TEST(ExactScaleSpace, DoesNotProjectToWhereNothingIs) {
  // A cap of a sphere that the point is inside of: the nearest place of the sphere is opposite the
  // cap, farther from it than the radius.
  const double radius = 0.85, shift = 0.05;
  test::Cloud cloud;
  cloud.add(Vec3::Zero(), Vec3::Zero());
  for (int i = 0; i < 12; ++i) {
    const double tilt = 0.05 * (1 + i % 3);
    const Vec3 n(std::cos(tilt), std::sin(tilt) * std::cos(i), std::sin(tilt) * std::sin(i));
    cloud.add(Vec3(shift, 0, 0) + radius * n, n);
  }
  ScaleSpaceOptions options;
  options.reconstruction = Reconstruction::kSphereMls;
  options.range.s_min = 0.95, options.range.s_max = 1.0;
  const ExactScaleSpace space(cloud.points(), options);
  const auto matrix = test::describe(space, {0});
  for (std::size_t s = 0; s < 16; ++s) {
    EXPECT_EQ(matrix.status_at(0, s), FitStatus::kStable);
    const double t = space.scales()[s];
    EXPECT_NEAR(matrix(0, s, 0) * t, (shift * shift - radius * radius) / (2 * radius), 1e-11);
    EXPECT_NEAR(matrix(0, s, 1), t / radius, 1e-11);
  }
}

TEST(ExactScaleSpace, LeavesNothingWhereNormalsCancel) {
  // The centre of a sphere is at a distance from it, but no gradient there tells a side.
  test::Cloud cloud;
  cloud.add(Vec3::Zero(), Vec3::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0})
      cloud.add(side * Vec3::Unit(axis), side * Vec3::Unit(axis));
  }
  ScaleSpaceOptions options;
  options.range.s_min = 1.2, options.range.s_max = 1.3;
  for (const auto reconstruction : {Reconstruction::kSphere, Reconstruction::kSphereMls}) {
    options.reconstruction = reconstruction;
    const ExactScaleSpace space(cloud.points(), options);
    const auto matrix = test::describe(space, {0});
    for (const FitStatus status : matrix.status) EXPECT_EQ(status, FitStatus::kUndefined);
    for (const double feature : matrix.features) EXPECT_EQ(feature, 0.0);
  }
}

TEST(ExactScaleSpace, CountsThePointItselfAndNeighboursWithinTheRadiusOnly) {
  // Seven points in a row, one apart: at radius t the middle one has those closer than t.
  test::Cloud cloud;
  for (int i = -3; i <= 3; ++i) cloud.add({double(i), 0, 0}, Vec3::UnitZ());
  ScaleSpaceOptions options;
  options.scales = 4;
  options.range.s_min = 0.5, options.range.s_max = 4.0;
  const auto matrix = test::describe(cloud, options);  // radii 0.5, 1, 2, 4
  EXPECT_EQ(matrix.status_at(3, 0), FitStatus::kUndefined);
  EXPECT_EQ(matrix.status_at(3, 1), FitStatus::kUndefined);  // those at distance 1 are not closer
  EXPECT_EQ(matrix.status_at(3, 2), FitStatus::kUnstable);   // 3: itself and one on each side
  EXPECT_EQ(matrix.status_at(3, 3), FitStatus::kStable);
  cloud.normals[0] = Vec3::Zero();
  EXPECT_EQ(test::describe(cloud, options).status_at(3, 3), FitStatus::kStable);
  cloud.normals[1] = Vec3::Zero();
  EXPECT_EQ(test::describe(cloud, options).status_at(3, 3), FitStatus::kUnstable);
  cloud.normals[3] = Vec3::Zero();
  EXPECT_EQ(test::describe(cloud, options).status_at(3, 2), FitStatus::kUndefined);
}

TEST(ExactScaleSpace, GateHidesTheFarSideOfAThinWall) {
  test::Cloud front, wall;
  test::Stream stream(8);
  for (int i = 0; i < 1500; ++i) {
    const Vec3 n = (Vec3::UnitZ() + 0.1 * stream.normal3()).normalized();
    const Vec3 p(stream.uniform(), stream.uniform(), 0.01 * stream.normal());
    front.add(p, n);
  }
  wall = front;
  for (std::size_t i = 0; i < 1500; ++i) {
    wall.add(front.positions[i] - 0.03 * Vec3::UnitZ(), -front.normals[i]);
  }
  ScaleSpaceOptions options;
  options.range.s_min = 0.05, options.range.s_max = 0.2;
  options.side_gate = -0.5;
  const auto targets = test::all_targets(1500);
  const auto alone = test::describe(ExactScaleSpace(front.points(), options), targets);
  const auto gated = test::describe(ExactScaleSpace(wall.points(), options), targets);
  expect_near(alone, gated, 1e-10);  // the same neighbours, summed in another order
  options.side_gate.reset();
  const auto open = test::describe(ExactScaleSpace(wall.points(), options), targets);
  EXPECT_NE(alone.features, open.features);
}

TEST(ExactScaleSpace, GateOfAPointWithoutNormalIsOpen) {
  test::Cloud cloud = test::awkward_cloud(800);
  ScaleSpaceOptions options;
  options.range.s_min = 0.05, options.range.s_max = 0.2;
  const std::vector<std::uint32_t> without_normal = {40, 140};
  const auto open = test::describe(ExactScaleSpace(cloud.points(), options), without_normal);
  options.side_gate = 0.1;
  test::expect_same_bits(open,
                         test::describe(ExactScaleSpace(cloud.points(), options), without_normal));
}

TEST(ExactScaleSpace, SurvivesPilesAndLinesOfPoints) {
  const auto [cloud, first] = test::cube_with_piles();
  for (const test::Variant& variant : kVariants) {
    const ExactScaleSpace space(cloud.points(), test::options_of(variant, FeatureSet::kAll28));
    const auto matrix = test::describe(space, {first, first + 1, first + 2});
    for (const double f : matrix.features) ASSERT_TRUE(std::isfinite(f)) << variant.name;
    for (std::size_t s = 0; s < 16; ++s) {
      const FitStatus line = is_plane(variant) ? FitStatus::kUndefined : FitStatus::kStable;
      EXPECT_EQ(matrix.status_at(0, s), FitStatus::kUndefined) << variant.name;  // one point
      EXPECT_EQ(matrix.status_at(1, s), FitStatus::kUndefined) << variant.name;
      EXPECT_EQ(matrix.status_at(2, s), line) << variant.name;
      EXPECT_NEAR(matrix(2, s, 0), 0.0, 1e-12);
    }
  }
}

TEST(ExactScaleSpace, RefusesWhatItCannotDescribe) {
  const auto kind = [](const test::Cloud& cloud, const ScaleSpaceOptions& options) {
    try {
      ExactScaleSpace(cloud.points(), options);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::kFailure;
  };
  const test::Cloud cube = test::cube(1000, 1);
  test::Cloud bad = cube;
  bad.normals.pop_back();
  EXPECT_EQ(kind(bad, {}), ErrorKind::kUsage);
  bad = cube;
  bad.normals[7] *= 1.1;
  EXPECT_EQ(kind(bad, {}), ErrorKind::kUsage);
  bad.normals[7] *= 1e200;
  EXPECT_EQ(kind(bad, {}), ErrorKind::kUsage);
  ScaleSpaceOptions options;
  options.scales = 15;
  EXPECT_EQ(kind(cube, options), ErrorKind::kUsage);
  options = {};
  options.side_gate = 1.5;
  EXPECT_EQ(kind(cube, options), ErrorKind::kUsage);
  options.side_gate = kNan;
  EXPECT_EQ(kind(cube, options), ErrorKind::kUsage);
  options = {};
  options.max_projection_steps = -1;
  EXPECT_EQ(kind(cube, options), ErrorKind::kUsage);
  EXPECT_EQ(kind({}, {}), ErrorKind::kInsufficient);
  bad = {};
  for (int i = 0; i < 100; ++i) bad.add({kNan, 0, 0}, Vec3::UnitX());
  EXPECT_EQ(kind(bad, {}), ErrorKind::kInsufficient);

  const ExactScaleSpace space(cube.points(), {});
  std::vector<float> out(16 * 6);
  std::vector<FitStatus> status(16);
  const std::vector<std::uint32_t> beyond = {1000}, two = {1, 2};
  EXPECT_ERROR(ErrorKind::kUsage, space.describe(beyond, std::span(out), status));
  EXPECT_ERROR(ErrorKind::kUsage, space.describe(two, std::span(out), status));
}

TEST(ExactScaleSpace, StopsWhenToldTo) {
  const test::Cloud cube = test::cube(1000, 1);
  Progress progress;
  progress.cancelled = [] { return true; };
  EXPECT_ERROR(ErrorKind::kCancelled, ExactScaleSpace(cube.points(), {}, &progress));
  const ExactScaleSpace space(cube.points(), {});
  std::vector<float> out(1000 * 16 * 6);
  std::vector<FitStatus> status(1000 * 16);
  EXPECT_ERROR(ErrorKind::kCancelled,
               space.describe(test::all_targets(1000), std::span<float>(out), status, &progress));
}

}  // namespace
}  // namespace pcednet::gls
