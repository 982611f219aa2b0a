#include "pcednet/detect/points/thinned_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "pcednet/core/parallel.h"
#include "pcednet/detect/points/far_points.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::detect {
namespace {

constexpr double kAveraged = 2.5;         ///< radius in deviations of the noise
constexpr std::size_t kLeastLeft = 4000;  ///< points: of fewer, too little is known

/// A point's voxel; in order, the points of a voxel follow each other.
struct InVoxel {
  std::array<double, 3> voxel;
  std::uint32_t point;

  bool operator<(const InVoxel& other) const {
    return std::tie(voxel, point) < std::tie(other.voxel, other.point);
  }
};

std::vector<InVoxel> by_voxels(std::span<const Vec3> points, const Averaging& averaging) {
  const double edge = ThickNoise{averaging.deviation, 0.0}.voxel();
  std::vector<InVoxel> sorted;
  sorted.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3 voxel = ((points[i] - averaging.middle) / edge).array().floor();
    sorted.push_back({{voxel.x(), voxel.y(), voxel.z()}, i});
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The mean of the points of each voxel; `points` are those on the curve, in its order, of `all`.
ThinnedCloud means_by_voxels(std::span<const Vec3> points, std::span<const std::uint32_t> curve,
                             const Averaging& averaging, std::size_t all) {
  ThinnedCloud thinned{
      .averaging = averaging, .positions = {}, .average_of = std::vector(all, kNoAverage)};
  const auto sorted = by_voxels(points, thinned.averaging);
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto end = std::find_if(begin, sorted.end(),
                                  [&](const InVoxel& one) { return one.voxel != begin->voxel; });
    const Vec3& first = points[begin->point];
    Vec3 sum = Vec3::Zero();
    for (auto one = begin; one != end; ++one) {
      sum += points[one->point] - first;
      thinned.average_of[curve[one->point]] = static_cast<std::uint32_t>(thinned.positions.size());
    }
    thinned.positions.push_back(first + sum / static_cast<double>(end - begin));
    begin = end;
  }
  return thinned;
}

/// Moves each to the mean of the points around it, twice.
void average(std::span<const Vec3> points, ThinnedCloud& thinned, const Progress* progress) {
  const spatial::KdTree tree(points);
  const auto move = [&](Vec3& place, std::vector<spatial::Neighbour>& near) {
    tree.within_unsorted(place, kAveraged * thinned.averaging.deviation, near);
    if (near.empty()) return;
    Vec3 sum = Vec3::Zero();
    for (const spatial::Neighbour& other : near) sum += points[other.index] - place;
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

}  // namespace

std::optional<ThinnedCloud> thin_noise(std::span<const Vec3> positions,
                                       std::span<const std::uint32_t> curve,
                                       const Progress* progress) {
  const auto noise = find_thick_noise(positions, curve);
  if (!noise) return std::nullopt;
  const std::vector<Vec3> points = spatial::in_order(positions, curve);
  ThinnedCloud thinned =
      means_by_voxels(points, curve, {noise->deviation, middle_of(points)}, positions.size());
  if (thinned.positions.size() < kLeastLeft) return std::nullopt;
  thinned.noise = *noise;
  average(points, thinned, progress);
  return thinned;
}

ThinnedCloud thin_as_decided(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                             const Averaging& averaging, const Progress* progress) {
  const std::vector<Vec3> points = spatial::in_order(positions, curve);
  ThinnedCloud thinned = means_by_voxels(points, curve, averaging, positions.size());
  average(points, thinned, progress);
  return thinned;
}

std::string note_on(const ThinnedCloud& thinned) {
  return fmt::format("{}: {} points are averaged to {}", text_of(thinned.noise),
                     thinned.average_of.size(), thinned.positions.size());
}

}  // namespace pcednet::detect
