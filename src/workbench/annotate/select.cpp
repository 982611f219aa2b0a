#include "workbench/annotate/select.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "pcednet/core/parallel.h"
#include "workbench/annotate/depth_buffer.h"

namespace pcednet::annotate {
namespace {

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

}  // namespace pcednet::annotate
