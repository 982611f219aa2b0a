#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/parallel.h"
#include "workbench/render/camera.h"
#include "workbench/render/preview.h"
#include "workbench/render/splat.h"

namespace pcednet::render {
namespace {

using Eigen::Vector3f;

constexpr int kWidth = 160, kHeight = 120;
constexpr float kEdgeShare = 0.6f;  // worth of seeing all edges, where seeing all surface is 1

struct View {
  Vector3f direction;
  float preference;
};

std::vector<View> candidates() {
  struct Elevation {
    int degrees_above;
    float preference;
  };
  std::vector<View> all;
  for (const Elevation elevation :
       {Elevation{12, 0.95f}, Elevation{27, 1.0f}, Elevation{48, 0.88f}}) {
    for (int azimuth = 15; azimuth < 375; azimuth += 30) {
      const Vec3 direction = direction_from(azimuth, elevation.degrees_above);
      all.push_back({direction.cast<float>(), elevation.preference});
    }
  }
  return all;
}

/// How much of the surface and of the edges is seen, each weighed by how squarely it is seen; the
/// inside of a surface counts against.
float score(std::span<const Surfel> surfels, const Vector3f& direction) {
  const Camera camera = frame(surfels, direction, kWidth, kHeight);
  const Layer layer = draw(surfels, camera, 0.7f);
  float surface = 0.0f, edges = 0.0f, all_edges = 0.0f;
  for (const Surfel& surfel : surfels) {
    all_edges += surfel.edge;
    const Vector3f p = camera.to_camera(surfel.position);
    const float x = 0.5f * kWidth + p.x() / p.z() * camera.focal;
    const float y = 0.5f * kHeight - p.y() / p.z() * camera.focal;
    if (!(p.z() > 0 && x >= 0 && x < kWidth && y >= 0 && y < kHeight)) continue;
    const std::size_t pixel = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
    const float slack = std::max(surfel.radius, 1.5f * p.z() / camera.focal);
    if (p.z() > layer.depth[pixel] + slack) continue;
    surface += -surfel.normal.dot(camera.axes.transpose() * p.normalized());
    edges += surfel.edge;
  }
  return surface / static_cast<float>(surfels.size()) +
         (all_edges > 0 ? kEdgeShare * edges / all_edges : 0.0f);
}

}  // namespace

Vec3 direction_from(double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  return -Vec3(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
}

Vector3f best_direction(std::span<const Surfel> surfels) {
  const std::vector<View> all = candidates();
  std::vector<float> scores(all.size());
  parallel_blocks(all.size(), 1, [&](std::size_t i, std::size_t) {
    scores[i] = all[i].preference * score(surfels, all[i].direction);
  });
  return all[static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) -
                                      scores.begin())]
      .direction;
}

}  // namespace pcednet::render
