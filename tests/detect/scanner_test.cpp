#include <gtest/gtest.h>

#include <cmath>

#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {
namespace {

/// A ball seen from outside, and the room around it seen from within: neighbours alone would have
/// the room's normals outwards.
PointCloud ball_in_a_room() {
  PointCloud cloud;
  std::vector<std::int32_t> scan;
  for (int i = 0; i < 4000; ++i) {
    // Evenly spread by the golden angle; the ball's points are closer.
    const double z = 1.0 - 2.0 * (i / 2 + 0.5) / 2000, angle = 2.399963229728653 * (i / 2);
    const double flat = std::sqrt(1.0 - z * z);
    const Vec3 direction(flat * std::cos(angle), flat * std::sin(angle), z);
    const bool room = i % 2 == 1;
    cloud.positions.push_back(direction * (room ? 5.0 : 1.0));
    // The ball is seen from the side that it shows.
    scan.push_back(room ? 2 : (z > 0.0 ? 0 : 1));
  }
  set_attribute(cloud, make_attribute("scan", scan));
  cloud.scanners = {Vec3(0, 0, 1000), Vec3(0, 0, -1000), Vec3(0, 0, 2)};
  return cloud;
}

double facing_outwards(const PointCloud& cloud, std::span<const Vec3> normals, int remainder) {
  double outwards = 0.0;
  for (std::size_t i = static_cast<std::size_t>(remainder); i < cloud.size(); i += 2) {
    outwards += normals[i].dot(cloud.positions[i]) > 0.0 ? 1.0 : 0.0;
  }
  return outwards / (static_cast<double>(cloud.size()) / 2);
}

TEST(Scanner, TurnsEstimatedNormalsTowardsIt) {
  const PointCloud cloud = ball_in_a_room();
  const PreparedCloud prepared = prepare(cloud);
  // Where the ball is seen at a grazing angle an estimated normal may face away.
  EXPECT_GT(facing_outwards(cloud, prepared.normals, 0), 0.99);
  EXPECT_EQ(facing_outwards(cloud, prepared.normals, 1), 0.0);
  ASSERT_EQ(prepared.notes.size(), 1u);
  EXPECT_NE(prepared.notes[0].find("turned towards the scanner"), std::string::npos);
}

TEST(Scanner, LeavesPointsOfUnknownScannersToTheirNeighbours) {
  PointCloud cloud = ball_in_a_room();
  cloud.scanners[2] = Vec3::Constant(NAN);
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_GT(facing_outwards(cloud, prepared.normals, 0), 0.99);
  EXPECT_EQ(facing_outwards(cloud, prepared.normals, 1), 1.0);
  EXPECT_NE(prepared.notes[0].find("2000 of them turned"), std::string::npos);
}

TEST(Scanner, DoesNotTouchTheNormalsOfTheFile) {
  PointCloud cloud = ball_in_a_room();
  cloud.normals.assign(cloud.size(), Vec3(0, 0, 1));
  EXPECT_EQ(prepare(cloud).normals.data(), cloud.normals.data());
}

}  // namespace
}  // namespace pcednet::detect
