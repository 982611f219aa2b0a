#include "workbench/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "workbench/render/preview.h"
#include "workbench/render/splat.h"

namespace pcednet::render {
namespace {

using Eigen::Vector3f;

constexpr float kHalfFieldOfView = 0.24f;  // radians, of the longer side
constexpr float kFilled = 0.88f;           // of the picture, by the centres of the discs

Eigen::Matrix3f axes_of(const Vector3f& direction) {
  const Vector3f forward = direction.normalized();
  const Vector3f up = std::abs(forward.z()) > 0.999f ? Vector3f::UnitY() : Vector3f::UnitZ();
  const Vector3f right = forward.cross(up).normalized();
  Eigen::Matrix3f axes;
  axes << right.transpose(), right.cross(forward).transpose(), forward.transpose();
  return axes;
}

struct Range {
  float low, high;
};

/// The range of all values, cut where it reaches a quarter further than that of the middle 99.6 %.
Range robust_range(std::vector<float>& values) {
  const std::size_t rank = values.size() / 500;
  const float low = value_at_rank(values, rank);
  const float high = value_at_rank(values, values.size() - 1 - rank);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const float margin = 0.25f * (high - low);
  return {std::max(*least, low - margin), std::min(*most, high + margin)};
}

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

Camera frame(std::span<const Surfel> surfels, const Vector3f& direction, int width, int height) {
  const float longer = static_cast<float>(std::max(width, height));
  Camera camera{axes_of(direction), Vector3f::Zero(), 0.5f * longer / std::tan(kHalfFieldOfView),
                width, height};
  const float half_x = kFilled * 0.5f * static_cast<float>(width) / camera.focal;
  const float half_y = kFilled * 0.5f * static_cast<float>(height) / camera.focal;

  std::vector<float> x, y, z;
  for (const Surfel& surfel : surfels) {
    const Vector3f p = camera.to_camera(surfel.position);
    x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  }
  std::vector<float> scratch = z;
  const Range depth = robust_range(scratch);
  const float nearest = std::max(0.5f * (depth.high - depth.low), 1e-3f);
  float distance = 10.0f;  // from the front of the scene to the eye
  Vector3f eye(0, 0, depth.low - distance);
  for (int step = 0; step < 8; ++step) {
    const auto projected = [&](const std::vector<float>& values, float origin) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        scratch[i] = (values[i] - origin) / std::max(z[i] - eye.z(), 0.1f * distance);
      }
      return robust_range(scratch);
    };
    const Range rx = projected(x, eye.x()), ry = projected(y, eye.y());
    const float fill =
        std::max((rx.high - rx.low) / (2 * half_x), (ry.high - ry.low) / (2 * half_y));
    const float middle = 0.5f * (depth.low + depth.high) - eye.z();
    eye.x() += 0.5f * (rx.low + rx.high) * middle;
    eye.y() += 0.5f * (ry.low + ry.high) * middle;
    distance = std::max(nearest, middle * fill - 0.5f * (depth.high - depth.low));
    eye.z() = depth.low - distance;
  }
  camera.eye = camera.axes.transpose() * eye;
  return camera;
}

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
