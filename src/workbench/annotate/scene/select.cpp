#include "workbench/annotate/scene/select.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "pcednet/core/parallel.h"

namespace pcednet::annotate {
namespace {

constexpr double kCell = 2;         // pixels a side
constexpr double kMostRadius = 48;  // pixels: close to the eye there are few points
constexpr double kSlope = 3;        // how steeply a surface may run away within a square

/// Where a point appears: x and y in clip space, and its distance along the view.
struct ViewedPoint {
  double x = 0, y = 0, depth = 0;
  bool visible = false;  ///< within the view's frustum
};

/// A camera as a page defines it: a column-major matrix to clip space, and the size of its picture
/// in pixels.
class View {
 public:
  View(const std::array<double, 16>& matrix, const std::array<double, 2>& viewport);

  ViewedPoint see(const Vec3& local) const;

  /// Pixels that a unit of length covers at `depth`.
  double pixels_per_unit(double depth) const;

  const std::array<double, 2>& viewport() const { return viewport_; }

 private:
  Eigen::Matrix4d matrix_;
  std::array<double, 2> viewport_;
  bool perspective_;
  double depth_scale_, x_scale_;
};

/// A z-buffer of a picture's cells, of points drawn as squares large enough to close the surface
/// between neighbours.
class DepthBuffer {
 public:
  DepthBuffer(const View& view, double point_size, double spacing);

  void add(const ViewedPoint& point);

  /// Whether something is clearly in front of `point`.
  bool covers(const ViewedPoint& point) const;

 private:
  double radius(const ViewedPoint& point) const;  ///< pixels

  const View& view_;
  double point_size_, spacing_;
  std::ptrdiff_t width_, height_;  ///< cells
  std::vector<float> nearest_;
};

View::View(const std::array<double, 16>& matrix, const std::array<double, 2>& viewport)
    : matrix_(Eigen::Map<const Eigen::Matrix4d>(matrix.data())), viewport_(viewport) {
  const double w_scale = matrix_.row(3).head<3>().norm();
  perspective_ = w_scale > 0;
  depth_scale_ = perspective_ ? w_scale : matrix_.row(2).head<3>().norm();
  x_scale_ = matrix_.row(0).head<3>().norm();
}

ViewedPoint View::see(const Vec3& local) const {
  const Eigen::Vector4d clip = matrix_ * Eigen::Vector4d(local.x(), local.y(), local.z(), 1.0);
  const double w = clip.w();
  if (!(w > 0) || (clip.head<3>().array().abs() > w).any()) return {};
  return {.x = clip.x() / w,
          .y = clip.y() / w,
          .depth = (perspective_ ? w : clip.z()) / std::max(depth_scale_, 1e-300),
          .visible = true};
}

double View::pixels_per_unit(double depth) const {
  const double w = perspective_ ? depth * depth_scale_ : 1.0;
  return 0.5 * viewport_[0] * x_scale_ / std::max(w, 1e-300);
}

DepthBuffer::DepthBuffer(const View& view, double point_size, double spacing)
    : view_(view),
      point_size_(point_size),
      spacing_(spacing),
      width_(static_cast<std::ptrdiff_t>(view.viewport()[0] / kCell) + 1),
      height_(static_cast<std::ptrdiff_t>(view.viewport()[1] / kCell) + 1),
      nearest_(static_cast<std::size_t>(width_ * height_), std::numeric_limits<float>::infinity()) {
}

double DepthBuffer::radius(const ViewedPoint& point) const {
  return std::min(std::max(0.5 * point_size_, spacing_ * view_.pixels_per_unit(point.depth)),
                  kMostRadius);
}

void DepthBuffer::add(const ViewedPoint& point) {
  const double r = radius(point);
  const double x = 0.5 * (point.x + 1) * view_.viewport()[0];
  const double y = 0.5 * (point.y + 1) * view_.viewport()[1];
  const auto cell = [](double pixel, std::ptrdiff_t cells) {
    return std::clamp(static_cast<std::ptrdiff_t>(std::floor(pixel / kCell)), std::ptrdiff_t{0},
                      cells - 1);
  };
  const auto depth = static_cast<float>(point.depth);
  for (std::ptrdiff_t j = cell(y - r, height_); j <= cell(y + r, height_); ++j) {
    for (std::ptrdiff_t i = cell(x - r, width_); i <= cell(x + r, width_); ++i) {
      float& nearest = nearest_[static_cast<std::size_t>(j * width_ + i)];
      nearest = std::min(nearest, depth);
    }
  }
}

bool DepthBuffer::covers(const ViewedPoint& point) const {
  const auto i = static_cast<std::ptrdiff_t>(0.5 * (point.x + 1) * view_.viewport()[0] / kCell);
  const auto j = static_cast<std::ptrdiff_t>(0.5 * (point.y + 1) * view_.viewport()[1] / kCell);
  const std::ptrdiff_t cell = std::clamp(j, std::ptrdiff_t{0}, height_ - 1) * width_ +
                              std::clamp(i, std::ptrdiff_t{0}, width_ - 1);
  const double square = (radius(point) + kCell) / view_.pixels_per_unit(point.depth);
  return point.depth > nearest_[static_cast<std::size_t>(cell)] + kSlope * square;
}

constexpr double kLeastCosine = -0.5;  // of 120 degrees
constexpr std::size_t kBlock = 16384;

/// Whether (x, y) is within the polygon, by the number of edges that a ray crosses.
bool is_within(const std::vector<std::array<double, 2>>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto& [xi, yi] = polygon[i];
    const auto& [xj, yj] = polygon[j];
    if ((yi > y) != (yj > y) && x < (xj - xi) * (y - yi) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

bool is_clipped(const Stroke& stroke, const Vec3& local) {
  return stroke.clip && ((local.array() < stroke.clip->min.array()).any() ||
                         (local.array() > stroke.clip->max.array()).any());
}

}  // namespace

Selector::Selector(std::span<const Vec3> positions, std::span<const Vec3> normals,
                   const Vec3& origin, double spacing)
    : positions_(positions),
      normals_(normals),
      origin_(origin),
      spacing_(spacing),
      tree_(positions) {}

std::vector<std::uint32_t> Selector::select(const Stroke& stroke) const {
  return stroke.tool == Tool::kBrush ? brush(stroke) : polygon(stroke);
}

std::vector<std::uint32_t> Selector::labelled(std::span<const std::uint8_t> labels,
                                              const Stroke& stroke) const {
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != stroke.edge_class || !positions_[i].allFinite()) continue;
    if (is_clipped(stroke, positions_[i] - origin_)) continue;
    points.push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

std::vector<std::uint32_t> Selector::brush(const Stroke& stroke) const {
  std::vector<std::uint8_t> met(positions_.size(), 0);
  parallel_blocks(stroke.centres.size(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> nearest, found;
    for (std::size_t c = begin; c < end; ++c) {
      const Vec3 centre = stroke.centres[c] + origin_;
      tree_.nearest(centre, 1, nearest);
      if (nearest.empty()) continue;
      const Vec3& facing = normals_[nearest[0].index];
      tree_.within_unsorted(centre, stroke.radius, found);
      for (const auto& [i, sq_distance] : found) {
        if (facing.dot(normals_[i]) < kLeastCosine) continue;
        if (is_clipped(stroke, positions_[i] - origin_)) continue;
        // Threads may visit the same point: they write the same byte.
        std::atomic_ref(met[i]).store(1, std::memory_order_relaxed);
      }
    }
  });
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < met.size(); ++i) {
    if (met[i]) points.push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

std::vector<std::uint32_t> Selector::polygon(const Stroke& stroke) const {
  const View view(stroke.matrix, stroke.viewport);
  std::vector<ViewedPoint> seen(positions_.size());
  parallel_blocks(positions_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // Clipped points are not drawn either, and so hide nothing.
      const Vec3 local = positions_[i] - origin_;
      if (local.allFinite() && !is_clipped(stroke, local)) seen[i] = view.see(local);
    }
  });
  DepthBuffer depths(view, stroke.point_size, spacing_);
  if (stroke.front_only) {
    for (const ViewedPoint& point : seen) {
      if (point.visible) depths.add(point);
    }
  }
  std::vector<std::uint8_t> met(positions_.size(), 0);
  parallel_blocks(positions_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!seen[i].visible || !is_within(stroke.polygon, seen[i].x, seen[i].y)) continue;
      met[i] = !stroke.front_only || !depths.covers(seen[i]);
    }
  });
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < met.size(); ++i) {
    if (met[i]) points.push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

std::vector<std::uint32_t> rank_uncertain(std::span<const Vec3> positions,
                                          const spatial::KdTree& tree,
                                          std::span<const float> confidence, double apart,
                                          std::size_t most) {
  std::vector<std::uint32_t> candidates;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i].allFinite()) candidates.push_back(static_cast<std::uint32_t>(i));
  }
  const auto is_surer = [&](std::uint32_t a, std::uint32_t b) {
    return confidence[a] != confidence[b] ? confidence[a] > confidence[b] : a > b;
  };
  // A heap: of all points few are asked for.
  std::make_heap(candidates.begin(), candidates.end(), is_surer);
  std::vector<std::uint32_t> places;
  std::vector<std::uint8_t> taken(positions.size(), 0);
  std::vector<spatial::Neighbour> found;
  while (!candidates.empty() && places.size() < most) {
    std::pop_heap(candidates.begin(), candidates.end(), is_surer);
    const std::uint32_t point = candidates.back();
    candidates.pop_back();
    if (taken[point]) continue;
    places.push_back(point);
    tree.within_unsorted(positions[point], apart, found);
    for (const auto& [i, sq_distance] : found) taken[i] = 1;
  }
  return places;
}

std::optional<Picked> pick(std::span<const Vec3> positions, const Vec3& origin,
                           const Vec3& direction, double radius) {
  const Vec3 along = direction.normalized();
  std::optional<Picked> first;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 offset = positions[i] - origin;
    const double distance = offset.dot(along);
    if (!(distance >= 0) || (first && distance >= first->distance)) continue;
    if ((offset - distance * along).squaredNorm() <= radius * radius) {
      first = Picked{static_cast<std::uint32_t>(i), distance};
    }
  }
  return first;
}

}  // namespace pcednet::annotate
