#include "workbench/report/scene.h"

#include <gtest/gtest.h>

#include "pcednet/core/random.h"
#include "support/expect_error.h"

namespace pcednet::report {
namespace {

const Vec3 kPlace(4e5, 5e6, 100);

/// Two faces of 2 x 2 that meet at a right angle in an edge from kPlace along y; near it, sharp.
PointCloud corner(std::size_t points) {
  Random random(7);
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double along = 2 * random.uniform(), away = 2 * random.uniform();
    const bool flat = i % 2 == 0;
    cloud.positions.push_back(kPlace + (flat ? Vec3(away, along, 0) : Vec3(0, along, away)));
    cloud.normals.push_back(flat ? Vec3::UnitZ() : Vec3::UnitX());
    cloud.labels.push_back(away < 0.1 ? kSharpEdge : kNonEdge);
  }
  return cloud;
}

TEST(DrawnLines, LieOnTheEdgeInStepsOfTheBox) {
  const PointCloud cloud = corner(4000);
  const Scene scene = make_scene(cloud, 500);
  const auto lines = find_drawn_lines(detect::prepare(cloud), cloud.labels, scene);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["class"], 2);
  EXPECT_NEAR(lines[0]["length"].get<double>(), 2.0, 0.1);
  const auto path = lines[0]["path"].get<std::vector<double>>();
  ASSERT_EQ(path.size(), 6u) << "a segment";
  for (const std::size_t i : {0u, 3u}) {
    const Vec3 step(path[i], path[i + 1], path[i + 2]);
    const Vec3 place = Vec3(scene.min[0], scene.min[1], scene.min[2]) + step / 65535 * scene.size;
    EXPECT_NEAR(place.x(), kPlace.x(), 0.01);
    EXPECT_NEAR(place.z(), kPlace.z(), 0.01);
    EXPECT_NEAR(std::abs(place.y() - kPlace.y() - 1.0), 1.0, 0.09) << "an end, by two spacings";
  }
}

TEST(DrawnLines, AreNoneWithoutEdgesAndOfOnePlace) {
  PointCloud cloud = corner(1000);
  const std::vector<std::uint8_t> none(1000, kNonEdge);
  const Scene scene = make_scene(cloud, 500);
  EXPECT_EQ(find_drawn_lines(detect::prepare(cloud), none, scene).size(), 0u);
  cloud.positions.assign(1000, kPlace);
  EXPECT_EQ(find_drawn_lines(detect::prepare(cloud), cloud.labels, make_scene(cloud, 500)).size(),
            0u);
}

TEST(DrawnLines, StopWhenTheUserSaysSo) {
  const PointCloud cloud = corner(1000);
  const Scene scene = make_scene(cloud, 500);
  const Progress progress{.report = {}, .cancelled = [] { return true; }};
  EXPECT_ERROR(ErrorKind::kCancelled,
               find_drawn_lines(detect::prepare(cloud), cloud.labels, scene, &progress));
}

}  // namespace
}  // namespace pcednet::report
