#include "workbench/shapes/perturb.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

namespace pcednet::shapes {
namespace {

/// Points in a box of diagonal 3, corners among them, each with a number of its own.
PointCloud box_of_points(std::size_t points) {
  Random random(5);
  PointCloud cloud;
  std::vector<std::uint16_t> numbers;
  for (std::size_t i = 0; i < points; ++i) {
    cloud.positions.push_back(uniform_vector(random, Vec3::Zero(), {1.0, 2.0, 2.0}));
    cloud.normals.push_back(normal_vector(random).normalized());
    cloud.labels.push_back(static_cast<std::uint8_t>(i % 3));
    cloud.colours.push_back({static_cast<std::uint8_t>(i), 0, 0});
    numbers.push_back(static_cast<std::uint16_t>(i));
  }
  cloud.positions[0] = Vec3(0, 0, 0);
  cloud.positions[1] = Vec3(1, 2, 2);
  cloud.attributes = {make_attribute("number", numbers)};
  cloud.foreign_elements = {{"element face 0\n", {}}};
  return cloud;
}

PointCloud reversed(PointCloud cloud) {
  std::reverse(cloud.positions.begin(), cloud.positions.end());
  std::reverse(cloud.normals.begin(), cloud.normals.end());
  return cloud;
}

TEST(Perturb, NoiseHasTheDeviationAskedForOnEachAxis) {
  const PointCloud clean = box_of_points(20000);
  const PointCloud noisy = add_gaussian_noise(clean, {.sigma = 0.01});
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const Vec3 move = noisy.positions[i] - clean.positions[i];
    sum += move;
    squares += move.cwiseAbs2();
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / 20000, 0.0, 4 * 0.03 / std::sqrt(20000.0));
    EXPECT_NEAR(std::sqrt(squares[axis] / 20000), 0.03, 0.0006);
  }
  EXPECT_EQ(noisy.normals, clean.normals);
  EXPECT_EQ(noisy.labels, clean.labels);
}

TEST(Perturb, NoiseAlongTheNormalStaysOnItsLine) {
  const PointCloud clean = box_of_points(20000);
  const PointCloud noisy = add_gaussian_noise(clean, {.sigma = 0.01, .along_normal = true});
  double squares = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const Vec3 move = noisy.positions[i] - clean.positions[i];
    EXPECT_NEAR(move.cross(clean.normals[i]).norm(), 0.0, 1e-15);
    squares += move.squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / 20000), 0.03, 0.0006);
}

TEST(Perturb, DoesNotDependOnHowPointsAreNumbered) {
  const PointCloud cloud = box_of_points(1000);
  for (const bool along_normal : {false, true}) {
    const NoiseOptions options = {.sigma = 0.1, .along_normal = along_normal, .seed = 3};
    EXPECT_EQ(reversed(add_gaussian_noise(cloud, options)).positions,
              add_gaussian_noise(reversed(cloud), options).positions);
  }
  EXPECT_EQ(reversed(subsample(cloud, {.fraction = 0.3})).positions,
            subsample(reversed(cloud), {.fraction = 0.3}).positions);
}

TEST(Perturb, AnotherSeedGivesAnotherResult) {
  const PointCloud cloud = box_of_points(1000);
  EXPECT_NE(add_gaussian_noise(cloud, {.seed = 1}).positions,
            add_gaussian_noise(cloud, {.seed = 2}).positions);
  EXPECT_NE(subsample(cloud, {.seed = 1}).positions, subsample(cloud, {.seed = 2}).positions);
}

TEST(Perturb, KeepsThePositionTypeAndPointsThatCannotMove) {
  PointCloud cloud = box_of_points(100);
  cloud.position_type = ScalarType::kFloat32;
  for (Vec3& p : cloud.positions) p = p.cast<float>().cast<double>();
  cloud.positions[7].x() = NAN;
  cloud.normals[8].setZero();
  const PointCloud noisy = add_gaussian_noise(cloud, {.sigma = 0.01, .along_normal = true});
  EXPECT_TRUE(std::isnan(noisy.positions[7].x()));
  EXPECT_EQ(noisy.positions[7].y(), cloud.positions[7].y());
  EXPECT_EQ(noisy.positions[8], cloud.positions[8]);
  EXPECT_NE(noisy.positions[9], cloud.positions[9]);
  EXPECT_EQ(noisy.positions[9], Vec3(noisy.positions[9].cast<float>().cast<double>()));
}

TEST(Perturb, SubsampleKeepsAllThatBelongsToAPoint) {
  PointCloud cloud = box_of_points(200);
  std::array<std::vector<double>, 3> axes;  // the normals three times as long
  for (const Vec3& normal : cloud.normals) {
    for (std::size_t axis = 0; axis < 3; ++axis) axes[axis].push_back(3 * normal.data()[axis]);
  }
  for (const auto& axis : axes) cloud.stored_normals.push_back(make_attribute("n", axis));
  const PointCloud kept = subsample(cloud, {.fraction = 0.25});
  ASSERT_EQ(kept.size(), 50u);
  check_consistent(kept);
  double previous = -1;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double number = kept.attributes[0].value(i);
    EXPECT_GT(number, previous);
    previous = number;
    const auto point = static_cast<std::size_t>(number);
    EXPECT_EQ(kept.positions[i], cloud.positions[point]);
    EXPECT_EQ(kept.normals[i], cloud.normals[point]);
    EXPECT_EQ(stored_normal(kept, i), stored_normal(cloud, point));
    EXPECT_EQ(kept.labels[i], cloud.labels[point]);
    EXPECT_EQ(kept.colours[i], cloud.colours[point]);
  }
  EXPECT_TRUE(kept.foreign_elements.empty());
  PointCloud surveyed = cloud;
  surveyed.foreign_elements.push_back({"element las_vlrs 1\n", {std::byte{7}}});
  const auto elements = subsample(surveyed, {.fraction = 0.25}).foreign_elements;
  ASSERT_EQ(elements.size(), 1u);
  EXPECT_EQ(elements[0].bytes, surveyed.foreign_elements[1].bytes);
}

TEST(Perturb, SelectKeepsThePointsThatAreNamed) {
  const PointCloud cloud = box_of_points(20);
  const std::vector<std::uint32_t> points = {19, 0, 7, 7};
  const PointCloud kept = select(cloud, points);
  check_consistent(kept);
  ASSERT_EQ(kept.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(kept.positions[i], cloud.positions[points[i]]);
    EXPECT_EQ(kept.labels[i], cloud.labels[points[i]]);
    EXPECT_EQ(kept.attributes[0].value(i), cloud.attributes[0].value(points[i]));
  }
  EXPECT_TRUE(select(cloud, {}).empty());
}

TEST(Perturb, SubsamplesAreUniformAndNested) {
  const PointCloud cloud = box_of_points(20000);
  const auto numbers = [&](double fraction) {
    const PointCloud kept = subsample(cloud, {.fraction = fraction});
    std::set<double> found;
    for (std::size_t i = 0; i < kept.size(); ++i) found.insert(kept.attributes[0].value(i));
    return found;
  };
  const auto tenth = numbers(0.1), half = numbers(0.5);
  EXPECT_EQ(tenth.size(), 2000u);
  EXPECT_EQ(half.size(), 10000u);
  EXPECT_TRUE(std::includes(half.begin(), half.end(), tenth.begin(), tenth.end()));
  const double mean = std::accumulate(half.begin(), half.end(), 0.0) / 10000;
  EXPECT_NEAR(mean, 10000, 4 * 20000 / std::sqrt(12 * 10000.0));
  EXPECT_EQ(numbers(1).size(), 20000u);
  EXPECT_TRUE(numbers(0).empty());
}

TEST(Perturb, ThinsToPointsThatAreApart) {
  PointCloud cloud = box_of_points(5000);
  for (std::size_t i = 0; i < 4000; ++i) cloud.positions[i] *= 0.1;  // far denser there
  cloud.positions[4000] = cloud.positions[4001];
  cloud.positions[4002].x() = NAN;
  const double spacing = 0.1 * bounding_box(cloud.positions).diagonal();
  const PointCloud kept = thin(cloud, {.spacing = spacing});
  check_consistent(kept);
  ASSERT_GT(kept.size(), 50u);
  ASSERT_LT(kept.size(), 1000u);
  const auto nearest = [&](const Vec3& at, const Vec3& other_than) {
    double least = INFINITY;
    for (const Vec3& p : kept.positions) {
      if (p != other_than) least = std::min(least, (p - at).norm());
    }
    return least;
  };
  double previous = -1;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_GE(nearest(kept.positions[i], kept.positions[i]), spacing);
    const double number = kept.attributes[0].value(i);
    EXPECT_GT(number, previous);
    previous = number;
    EXPECT_EQ(kept.positions[i], cloud.positions[static_cast<std::size_t>(number)]);
  }
  for (const Vec3& p : cloud.positions) {
    if (!p.allFinite()) continue;
    EXPECT_LT(nearest(p, Vec3::Constant(NAN)), spacing);
  }
  EXPECT_EQ(reversed(thin(cloud, {.spacing = spacing})).positions,
            thin(reversed(cloud), {.spacing = spacing}).positions);
  EXPECT_NE(thin(cloud, {.spacing = spacing, .seed = 2}).positions, kept.positions);
}

TEST(Perturb, RefusesWhatMakesNoSense) {
  PointCloud cloud = box_of_points(10);
  EXPECT_ERROR(ErrorKind::kUsage, add_gaussian_noise(cloud, {.sigma = -1}));
  EXPECT_ERROR(ErrorKind::kUsage, add_gaussian_noise(cloud, {.sigma = NAN}));
  EXPECT_ERROR(ErrorKind::kUsage, subsample(cloud, {.fraction = 1.5}));
  EXPECT_ERROR(ErrorKind::kUsage, subsample(cloud, {.fraction = NAN}));
  cloud.normals.clear();
  EXPECT_ERROR(ErrorKind::kInsufficient, add_gaussian_noise(cloud, {.along_normal = true}));
  EXPECT_EQ(add_gaussian_noise({}).size(), 0u);
  EXPECT_EQ(subsample({}).size(), 0u);
  EXPECT_EQ(thin({}, {.spacing = 1.0}).size(), 0u);
  for (const double spacing : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    EXPECT_ERROR(ErrorKind::kUsage, thin(cloud, {.spacing = spacing}));
  }
}

}  // namespace
}  // namespace pcednet::shapes
