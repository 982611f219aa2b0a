#pragma once

#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::gls {

inline constexpr int kMinScales = 4, kMaxScales = 128;

struct ScaleRange {
  double s_min = 0.0;
  double s_max = 0.0;
};

/// The mean over `positions` (the finite points of `tree`, in an order that fixes the sum) of the
/// mean distance to the 10 nearest other points, or to all others if they are fewer.
double mean_spacing(std::span<const Vec3> positions, const spatial::KdTree& tree);

/// s_min = mean_spacing(), s_max = 10 % of the diagonal of the bounding box; what `given` holds
/// other than 0 is kept. Throws Error(kInsufficient) where the cloud leaves no range: fewer than
/// two points, all in one place, every point with ten copies, or so few points that their spacing
/// is not below s_max. Throws Error(kUsage) if a given bound is negative, not finite, or leaves
/// none.
ScaleRange scale_range(std::span<const Vec3> positions, const spatial::KdTree& tree,
                       const ScaleRange& given);

/// `count` scales, smallest first: s_i = s_min (s_max / s_min)^((i - 1) / (count - 1)).
/// Throws Error(kUsage) unless count is 4, 8, 16, 32, 64 or 128 and 0 < s_min < s_max.
std::vector<double> sample_scales(const ScaleRange& range, int count);

}  // namespace pcednet::gls
