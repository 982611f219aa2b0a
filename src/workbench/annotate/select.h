#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pcednet/spatial/kd_tree.h"
#include "workbench/annotate/stroke.h"

namespace pcednet::annotate {

/// Finds the points that a stroke covers. The spans must outlive it.
class Selector {
 public:
  /// `origin` is what local coordinates are relative to; `spacing` the distance of neighbouring
  /// points.
  Selector(std::span<const Vec3> positions, std::span<const Vec3> normals, const Vec3& origin,
           double spacing);

  /// The points that `stroke` covers, ascending; ignores protect and hidden. A ball of the brush
  /// covers points within its radius whose normal differs by at most 120 degrees from that of the
  /// point nearest to its centre. A polygon covers points within it between the near and the far
  /// plane; with front_only, those that no nearer point hides.
  std::vector<std::uint32_t> select(const Stroke& stroke) const;

  const spatial::KdTree& tree() const { return tree_; }

 private:
  std::vector<std::uint32_t> brush(const Stroke& stroke) const;
  std::vector<std::uint32_t> polygon(const Stroke& stroke) const;

  std::span<const Vec3> positions_, normals_;
  Vec3 origin_;
  double spacing_;
  spatial::KdTree tree_;
};

}  // namespace pcednet::annotate
