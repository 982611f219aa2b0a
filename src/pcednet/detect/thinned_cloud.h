#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/thick_noise.h"

namespace pcednet::detect {

/// Fewer points in place of a cloud's, with less noise: no scale near the spacing shows an edge
/// through noise that is thicker than the spacing.
struct ThinnedCloud {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  ThickNoise noise;
  std::vector<Vec3> positions;           ///< one for each voxel with points
  std::vector<std::uint32_t> of_points;  ///< the number of each point's, or kNone: not finite
};

/// Whether the points of such clouds are thinned before this model classifies them. A model without
/// experts knows the points as they are from its training, and so do those who give s_min.
bool thins_noise(const EdgeModel& model);

/// Thins a cloud with thick noise, see find_thick_noise(); nothing if it has none, or if fewer than
/// 4,000 points would be left. Points are grouped by voxels of 2.4 deviations, and a group becomes
/// the mean of the points within 2.5 deviations of its own mean, and then of those around that. The
/// voxels lie about the median of the points: the result follows the cloud to another origin and
/// does not depend on the points' order. Throws Error(kCancelled) when `progress` asks to cancel.
std::optional<ThinnedCloud> thin_noise(std::span<const Vec3> positions,
                                       const Progress* progress = nullptr);

/// For the user: "noise is 2.1 times the spacing: 500000 points are averaged to 60000".
std::string note_on(const ThinnedCloud& thinned);

/// What was found of the thinned points, for all: each gets that of its own.
Classification found_for_all(const Classification& found, const ThinnedCloud& thinned);

/// Normals of all points; (0,0,0) for those that are not finite.
std::vector<Vec3> normals_for_all(std::span<const Vec3> normals, const ThinnedCloud& thinned);

/// Edge classes of all points, and their probabilities or none.
struct GivenLabels {
  std::span<const std::uint8_t> classes;
  std::span<const float> p_sharp = {}, p_smooth = {};
};

/// The other way, from the edge classes of all points: each thinned one has that of most of its
/// points (others than these four are non-edge) and their mean probabilities, if there are any.
Classification found_for_thinned(const GivenLabels& labels, const ThinnedCloud& thinned);

}  // namespace pcednet::detect
