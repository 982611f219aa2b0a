#include "pcednet/detect/cloud_kind.h"

#include <gtest/gtest.h>

#include "labelled_cube.h"
#include "pcednet/core/random_vectors.h"

namespace pcednet::detect {
namespace {

TEST(CloudKind, HasTheCloudsOfWhichAllHolds) {
  const CloudTraits few = {.points = 10, .estimated = true}, many = {.estimated = true};
  const CloudTraits given = {.points = 10};
  EXPECT_TRUE(CloudKind{}.has(few) && CloudKind{}.has(given));
  EXPECT_TRUE((CloudKind{.below = 11}.has(few)));
  EXPECT_FALSE((CloudKind{.below = 10}.has(few)));
  EXPECT_FALSE((CloudKind{.below = 11}.has(many)));
  EXPECT_TRUE((CloudKind{.estimated = true}.has(many)));
  EXPECT_FALSE((CloudKind{.estimated = true}.has(given)));
  EXPECT_FALSE((CloudKind{.estimated = false}.has(few)));
  EXPECT_FALSE((CloudKind{.exact = true}.has(few)));
  EXPECT_TRUE((CloudKind{.exact = true}.has({.exact = true})));
  EXPECT_FALSE((CloudKind{.noisy = true}.has(few)));
  EXPECT_TRUE((CloudKind{.noisy = true}.has({.noisy = true})));
}

TEST(CloudKind, IsReadAsItIsWritten) {
  const CloudKind kind = {.below = 4000, .estimated = true, .exact = true};
  EXPECT_EQ(text_of(kind), "below=4000,estimated,exact");
  EXPECT_EQ(cloud_kind_of(text_of(kind)), kind);
  EXPECT_EQ(cloud_kind_of("noisy,estimated"), (CloudKind{.estimated = true, .noisy = true}));
  EXPECT_EQ(text_of({.noisy = true}), "noisy");
  EXPECT_EQ(cloud_kind_of("exact,given"), (CloudKind{.estimated = false, .exact = true}));
  for (const char* text :
       {"", "below", "below=", "below=0", "below=-1", "below=4x", "exact,", "exact,exact",
        "noisy,noisy", "given,estimated", "Exact", "below=1,below=2"}) {
    EXPECT_FALSE(cloud_kind_of(text)) << text;
  }
}

TEST(CloudKind, CountsEachPlaceOnce) {
  PointCloud cloud = with_own_normals(cube(500, 1));
  cloud.labels.clear();
  for (std::size_t i = 0; i < 500; ++i) {
    cloud.positions.push_back(cloud.positions[i]);
    cloud.normals.push_back(cloud.normals[i]);
  }
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_EQ(traits_of(prepared, {}).points, 500u);
  gls::ScaleSpaceOptions scales_given;
  scales_given.range.s_min = 0.1, scales_given.range.s_max = 1.0;
  EXPECT_EQ(traits_of(prepared, scales_given).points, CloudTraits{}.points);
  EXPECT_FALSE(traits_of(prepared, {}).estimated);
}

TEST(CloudKind, TakesFewPointsOfVaryingSpacingForAPieceOfMore) {
  PointCloud cloud = with_own_normals(cube(500, 1));
  cloud.labels.clear();
  for (std::size_t i = 0; i < 500; ++i) {
    cloud.positions.push_back(Vec3(20.0, 0.0, 0.0) + 10.0 * cloud.positions[i]);
    cloud.normals.push_back(cloud.normals[i]);
  }
  gls::ScaleSpaceOptions options;
  options.range.s_max_ratio = 8.0;
  EXPECT_EQ(traits_of(prepare(cloud), options).points, 1000u);
  options.range.octaves = true;
  EXPECT_EQ(traits_of(prepare(cloud), options).points, CloudTraits{}.points);
}

TEST(CloudKind, TakesNormalsThatWereEstimatedBeforeForEstimated) {
  PointCloud cloud = with_own_normals(cube(600, 1));
  EXPECT_FALSE(traits_of(prepare(cloud), {}).estimated);
  cloud.normals.clear();
  cloud.normals = prepare(cloud).made;
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_FALSE(prepared.decision.made);
  EXPECT_TRUE(traits_of(prepared, {}).estimated);
}

TEST(CloudKind, TakesAFewNormalsThatAreNoNumbersForUnusable) {
  PointCloud cloud = cube(1000, 1);
  cloud.normals.clear();
  cloud.normals = prepare(cloud).made;
  for (std::size_t i = 0; i < 9; ++i) cloud.normals[100 * i + 50].setConstant(NAN);
  const PreparedCloud prepared = prepare(cloud);
  ASSERT_FALSE(prepared.decision.made);
  EXPECT_TRUE(traits_of(prepared, {}).estimated);
}

TEST(CloudKind, IsNoisyWhereMoreNeighboursEstimateTheNormals) {
  PointCloud cloud = cube(3000, 1);
  cloud.normals.clear();
  EXPECT_FALSE(traits_of(prepare(cloud), {}).noisy);
  Random random(1);
  for (Vec3& position : cloud.positions) {  // half the spacing
    position += 0.02 * normal_vector(random);
  }
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_GT(prepared.decision.neighbours, 12u);
  EXPECT_TRUE(traits_of(prepared, {}).noisy);
  cloud.normals = prepared.made;  // such as others would have estimated
  EXPECT_FALSE(traits_of(prepare(cloud), {}).noisy);
}

TEST(CloudKind, IsNotNoisyWhereScanLinesAreFarApart) {
  Random random(1);
  PointCloud cloud;  // the nearest 12 to 24 of a point are on its own line
  for (int line = 0; line < 60; ++line) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 noise = normal_vector(random);
      cloud.positions.push_back(Vec3(8.0 * line, i + random.uniform(-0.3, 0.3), 0.0) + 0.1 * noise);
    }
  }
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_GT(prepared.decision.neighbours, 12u);
  EXPECT_FALSE(traits_of(prepared, {}).noisy);
  for (const Vec3& normal : prepared.normals) EXPECT_GT(std::abs(normal.z()), 0.9);
}

}  // namespace
}  // namespace pcednet::detect
