#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/spatial/kd_tree.h"
#include "workbench/annotate/project/stroke.h"

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

  /// The points whose `labels` are the class of the stroke, within its clip box, ascending.
  std::vector<std::uint32_t> labelled(std::span<const std::uint8_t> labels,
                                      const Stroke& stroke) const;

  const spatial::KdTree& tree() const { return tree_; }

 private:
  std::vector<std::uint32_t> brush(const Stroke& stroke) const;
  std::vector<std::uint32_t> polygon(const Stroke& stroke) const;

  std::span<const Vec3> positions_, normals_;
  Vec3 origin_;
  double spacing_;
  spatial::KdTree tree_;
};

/// The points of least confidence, the least first, none closer to an earlier one than `apart`; at
/// most `most`. `tree` is of `positions`; points that are not finite are left out.
std::vector<std::uint32_t> rank_uncertain(std::span<const Vec3> positions,
                                          const spatial::KdTree& tree,
                                          std::span<const float> confidence, double apart,
                                          std::size_t most = 200);

struct Picked {
  std::uint32_t point = 0;
  double distance = 0;  ///< along the ray
};

/// The first point within `radius` of the ray from `origin` along `direction` (any length but 0).
std::optional<Picked> pick(std::span<const Vec3> positions, const Vec3& origin,
                           const Vec3& direction, double radius);

}  // namespace pcednet::annotate
