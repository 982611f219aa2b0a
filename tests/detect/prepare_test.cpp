#include "pcednet/detect/prepare.h"

#include <gtest/gtest.h>

#include "pcednet/core/random.h"

namespace pcednet::detect {
namespace {

/// Points of the unit sphere with their normals, of which every `nth` is missing.
PointCloud sphere(std::size_t points, std::size_t nth) {
  Random random(3);
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const Vec3 normal = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    cloud.positions.push_back(normal);
    cloud.normals.push_back(i % nth == 0 ? Vec3::Zero() : normal);
  }
  return cloud;
}

TEST(Prepare, EstimatesWhatIsMissingOfTheNormals) {
  const PointCloud cloud = sphere(4000, 2);
  const PreparedCloud prepared = prepare(cloud);
  const double sign = prepared.normals[1].dot(cloud.normals[1]) > 0 ? 1 : -1;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_GT(sign * prepared.normals[i].dot(cloud.positions[i]), i % 2 == 0 ? 0.95 : 0.999999);
  }
  ASSERT_EQ(prepared.notes.size(), 1U);
  EXPECT_NE(prepared.notes[0].find("2000 of 4000 points have no usable normal: estimated"),
            std::string::npos);
}

TEST(Prepare, LeavesTheFilesNormalsAloneIfFewAreMissing) {
  const PointCloud cloud = sphere(4000, 200);
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_TRUE(prepared.estimated.empty());
  EXPECT_EQ(prepared.normals.data(), cloud.normals.data());
  ASSERT_EQ(prepared.notes.size(), 1U);
  EXPECT_NE(prepared.notes[0].find("20 of 4000"), std::string::npos);
}

}  // namespace
}  // namespace pcednet::detect
