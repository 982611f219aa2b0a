#include "pcednet/detect/thinned_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/decide.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::detect {
namespace {

constexpr double kVoxel = 2.4, kAveraged = 2.5;  ///< in deviations of the noise
constexpr std::size_t kLeastLeft = 4000;         ///< points: of fewer, too little is known

/// A point's voxel; in order, the points of a voxel follow each other.
struct InVoxel {
  std::array<double, 3> voxel;
  std::uint32_t place;  ///< of the point on the curve

  bool operator<(const InVoxel& other) const {
    return std::tie(voxel, place) < std::tie(other.voxel, other.place);
  }
};

Vec3 median_of(std::span<const Vec3> positions, std::span<const std::uint32_t> curve) {
  Vec3 middle;
  std::vector<double> values(curve.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(curve.begin(), curve.end(), values.begin(),
                   [&](std::uint32_t i) { return positions[i][axis]; });
    middle[axis] = value_at_rank(values, values.size() / 2);
  }
  return middle;
}

std::vector<InVoxel> by_voxels(std::span<const Vec3> positions,
                               std::span<const std::uint32_t> curve, double edge) {
  const Vec3 middle = median_of(positions, curve);
  std::vector<InVoxel> sorted;
  sorted.reserve(curve.size());
  for (std::uint32_t place = 0; place < curve.size(); ++place) {
    const Vec3 voxel = ((positions[curve[place]] - middle) / edge).array().floor();
    sorted.push_back({{voxel.x(), voxel.y(), voxel.z()}, place});
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The mean of the points of each voxel; numbers the voxels in `thinned`.
void take_means(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                ThinnedCloud& thinned) {
  const auto sorted = by_voxels(positions, curve, kVoxel * thinned.noise.deviation);
  thinned.of_points.assign(positions.size(), ThinnedCloud::kNone);
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto end = std::find_if(begin, sorted.end(),
                                  [&](const InVoxel& one) { return one.voxel != begin->voxel; });
    const Vec3& first = positions[curve[begin->place]];
    Vec3 sum = Vec3::Zero();
    for (auto one = begin; one != end; ++one) {
      sum += positions[curve[one->place]] - first;
      thinned.of_points[curve[one->place]] = static_cast<std::uint32_t>(thinned.positions.size());
    }
    thinned.positions.push_back(first + sum / static_cast<double>(end - begin));
    begin = end;
  }
}

/// Moves each to the mean of the points around it, twice.
void average(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
             ThinnedCloud& thinned, const Progress* progress) {
  const std::vector<Vec3> ordered = spatial::in_order(positions, curve);
  const spatial::KdTree tree(ordered);
  const auto move = [&](Vec3& place, std::vector<spatial::Neighbour>& near) {
    tree.within_unsorted(place, kAveraged * thinned.noise.deviation, near);
    if (near.empty()) return;
    Vec3 sum = Vec3::Zero();
    for (const spatial::Neighbour& other : near) sum += ordered[other.index] - place;
    place += sum / static_cast<double>(near.size());
  };
  Stage stage(progress, "noise", thinned.positions.size());
  parallel_blocks(thinned.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      for (int time = 0; time < 2; ++time) move(thinned.positions[i], near);
    }
    stage.advance(end - begin);
  });
}

template <typename T>
std::vector<T> for_all(std::span<const T> values, const ThinnedCloud& thinned, const T& missing) {
  if (values.empty()) return {};
  std::vector<T> all(thinned.of_points.size(), missing);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (thinned.of_points[i] != ThinnedCloud::kNone) all[i] = values[thinned.of_points[i]];
  }
  return all;
}

std::vector<float> means_of(std::span<const float> values, const ThinnedCloud& thinned) {
  if (values.empty()) return {};
  std::vector<double> sums(thinned.positions.size(), 0.0), counts(sums.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t own = thinned.of_points[i];
    if (own == ThinnedCloud::kNone) continue;
    sums[own] += static_cast<double>(values[i]);
    counts[own] += 1.0;
  }
  std::vector<float> means(sums.size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] = static_cast<float>(sums[i] / counts[i]);
  }
  return means;
}

}  // namespace

bool thins_noise(const EdgeModel& model) {
  return !model.experts.empty() && model.descriptor.range.s_min == 0.0;
}

std::optional<ThinnedCloud> thin_noise(std::span<const Vec3> positions, const Progress* progress) {
  const std::vector<std::uint32_t> curve = spatial::curve_order(positions);
  const auto noise = find_thick_noise(positions, curve);
  if (!noise) return std::nullopt;
  ThinnedCloud thinned{*noise, {}, {}};
  take_means(positions, curve, thinned);
  if (thinned.positions.size() < kLeastLeft) return std::nullopt;
  average(positions, curve, thinned, progress);
  return thinned;
}

std::string note_on(const ThinnedCloud& thinned) {
  return fmt::format("noise is {:.2g} times the spacing: {} points are averaged to {}",
                     thinned.noise.deviation / thinned.noise.spacing, thinned.of_points.size(),
                     thinned.positions.size());
}

Classification found_for_all(const Classification& found, const ThinnedCloud& thinned) {
  Classification all = found;
  all.classes = for_all<std::uint8_t>(found.classes, thinned, kUnlabelled);
  all.p_sharp = for_all<float>(found.p_sharp, thinned, 0.0f);
  all.p_smooth = for_all<float>(found.p_smooth, thinned, 0.0f);
  all.p_class = for_all<float>(found.p_class, thinned, 0.0f);
  all.counts = count_classes(all.classes);
  return all;
}

std::vector<Vec3> normals_for_all(std::span<const Vec3> normals, const ThinnedCloud& thinned) {
  return for_all<Vec3>(normals, thinned, Vec3::Zero());
}

Classification found_for_thinned(const Classification& found, const ThinnedCloud& thinned) {
  std::vector<std::array<std::uint32_t, kBoundary + 1>> votes(thinned.positions.size());
  for (std::size_t i = 0; i < found.classes.size(); ++i) {
    if (thinned.of_points[i] == ThinnedCloud::kNone || found.classes[i] == kUnlabelled) continue;
    const bool is_edge_class = found.classes[i] <= kBoundary;
    ++votes[thinned.of_points[i]][is_edge_class ? found.classes[i] : 0];
  }
  Classification fewer;
  for (const auto& of_point : votes) {
    const auto most = std::max_element(of_point.begin(), of_point.end());
    fewer.classes.push_back(static_cast<std::uint8_t>(most - of_point.begin()));
    if (*most == 0) fewer.classes.back() = kUnlabelled;
  }
  fewer.p_sharp = means_of(found.p_sharp, thinned);
  fewer.p_smooth = means_of(found.p_smooth, thinned);
  fewer.counts = count_classes(fewer.classes);
  return fewer;
}

}  // namespace pcednet::detect
