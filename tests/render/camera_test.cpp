#include "workbench/render/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pcednet::render {
namespace {

using Eigen::Vector3f;

std::vector<Surfel> box(const Vector3f& half, const Vector3f& centre) {
  std::vector<Surfel> surfels;
  for (int i = 0; i < 512; ++i) {
    const Vector3f unit(i % 8 / 3.5f - 1, i / 8 % 8 / 3.5f - 1, i / 64 / 3.5f - 1);
    surfels.push_back({centre + unit.cwiseProduct(half), Vector3f::UnitZ(), 0.1f, Rgb{}, false});
  }
  return surfels;
}

TEST(Camera, FramesABoxFromAnywhere) {
  const std::vector<Surfel> surfels = box(Vector3f(1, 0.5f, 0.2f), Vector3f(0.3f, -0.1f, 0.2f));
  for (const Vector3f& direction : {Vector3f(0, 1, 0), Vector3f(0, 0, -2), Vector3f(-3, 1, -0.5f),
                                    Vector3f(0, 0, 1), Vector3f(1, 1, 1)}) {
    for (const auto& [width, height] : {std::pair{400, 300}, std::pair{200, 600}}) {
      const Camera camera = frame(surfels, direction, width, height);
      EXPECT_TRUE((camera.axes * camera.axes.transpose()).isIdentity(1e-5f));
      EXPECT_TRUE(camera.axes.row(2).transpose().isApprox(direction.normalized(), 1e-5f));
      float most = 0.0f;
      for (const Surfel& surfel : surfels) {
        const Vector3f p = camera.to_camera(surfel.position);
        ASSERT_GT(p.z(), 0.0f);
        most = std::max({most, std::abs(p.x() / p.z()) * camera.focal / (0.5f * width),
                         std::abs(p.y() / p.z()) * camera.focal / (0.5f * height)});
      }
      EXPECT_NEAR(most, 0.88f, 0.02f) << direction.transpose();
    }
  }
}

TEST(Camera, KeepsTheVerticalUpright) {
  const Camera camera = frame(box(Vector3f(1, 1, 1), Vector3f::Zero()), Vector3f(-1, 2, -1), 4, 3);
  const Vector3f up = camera.axes * Vector3f::UnitZ();
  EXPECT_NEAR(up.x(), 0.0f, 1e-6f);
  EXPECT_GT(up.y(), 0.0f);
}

TEST(Camera, LooksAtTheSideThatHasTheEdges) {
  for (const int side : {-1, 1}) {
    std::vector<Surfel> surfels = box(Vector3f(1, 1, 1), Vector3f::Zero());
    for (Surfel& surfel : surfels) {
      surfel.normal = surfel.position.normalized();
      surfel.radius = 0.5f;
      surfel.edge = surfel.position.y() * static_cast<float>(side) > 0.99f;
    }
    EXPECT_LT(best_direction(surfels).y() * static_cast<float>(side), -0.5f);
    EXPECT_LT(best_direction(surfels).z(), 0.0f);
  }
}

}  // namespace
}  // namespace pcednet::render
