#include "pcednet/gls/engine/voxel_pyramid.h"

#include <algorithm>
#include <utility>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/prefetch.h"
#include "pcednet/gls/engine/voxel_merge.h"

namespace pcednet::gls {
namespace {

/// A level is worth its memory when the average point shares its voxel with most of another.
constexpr double kWorthwhileMerge = 1.6;

/// least_merged() from which clumps that the forecast does not see are worth it, too: the sums over
/// their points would cost several times what those over all others do.
constexpr double kClumped = 8.0;

/// MergeForecast::filling from which a level costs far more than one of a surface. As with merging,
/// the average point decides, so that a tree before a wall does not coarsen anything. With a gate
/// every source costs more.
constexpr double kCrowded = 9.0, kCrowdedGated = 8.0;

/// How to make the level of a scale from the preceding level; `crowd`: how that one was made.
PyramidPlan::Level plan_level(VoxelSpan finer, MergeCells cells, bool gated, Crowd& crowd) {
  cells.crowd = crowd;
  MergeForecast forecast = forecast_merge(finer, cells);
  if (forecast.filling > (gated ? kCrowdedGated : kCrowded)) {
    cells.crowd = gated ? Crowd::kMergeByAxis : Crowd::kMerge;
    // The filling of voxels without axes is unknown: they are merged further.
    if (!gated) crowd = Crowd::kMerge;
    forecast = forecast_merge(finer, cells);
  }
  const bool is_worthwhile =
      forecast.merged >= kWorthwhileMerge || least_merged(finer, cells) >= kClumped;
  return {is_worthwhile, cells.crowd};
}

void add_boxes(VoxelLevel& level) {
  const VoxelSpan voxels = level.voxels;
  level.boxes = spatial::BoxTree(voxels.size(), [&](std::size_t i) { return voxels.position(i); });
}

}  // namespace

VoxelPyramid make_pyramid(std::span<const Vec3> positions, std::span<const Vec3> normals,
                          std::span<const std::uint32_t> order, double unit,
                          const PyramidPlan* whole) {
  VoxelPyramid pyramid;
  VoxelLevel& points = pyramid.levels.emplace_back();
  points.voxels = VoxelArray::of_points(order.size());
  constexpr std::size_t kStretch = 1 << 14;
  std::vector<std::pair<Vec3, Vec3>> corners((order.size() + kStretch - 1) / kStretch);
  parallel_blocks(order.size(), kStretch, [&](std::size_t begin, std::size_t end) {
    Vec3 min = positions[order[begin]] * unit, max = min;
    for (std::size_t i = begin; i < end; ++i) {
      if (i + kAskAhead < end) {
        prefetch(positions[order[i + kAskAhead]]);
        prefetch(normals[order[i + kAskAhead]]);
      }
      const Vec3& n = normals[order[i]];
      const Vec3 position = positions[order[i]] * unit;
      const Eigen::Vector3f normal = n.cast<float>();
      points.voxels.set_point(
          i, position,
          is_usable(n) ? MeanNormal{normal.x(), normal.y(), normal.z()} : MeanNormal{});
      min = min.cwiseMin(position);
      max = max.cwiseMax(position);
    }
    corners[begin / kStretch] = {min, max};
  });
  if (order.empty()) return pyramid;
  auto [min, max] = corners.front();
  for (const auto& [low, high] : corners) min = min.cwiseMin(low), max = max.cwiseMax(high);
  pyramid.origin = whole ? Vec3(whole->corner * unit) : min;
  pyramid.side = whole ? whole->side * unit : (max - min).maxCoeff();
  add_boxes(points);
  return pyramid;
}

void make_levels(VoxelPyramid& pyramid, std::span<const double> scales, const LevelOptions& options,
                 const Progress* progress) {
  Stage stage(progress, "resolutions", scales.size());
  pyramid.levels.resize(1);
  pyramid.levels.reserve(1 + scales.size());
  pyramid.level_of.clear(), pyramid.plan.clear();
  Crowd crowd = Crowd::kKeep;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    MergeCells cells = {.origin = pyramid.origin,
                        .side = pyramid.side,
                        .edge = options.eps * scales[i],
                        .crowd = {}};
    const VoxelSpan finer = pyramid.levels.back().voxels;
    const PyramidPlan::Level plan = options.whole ? options.whole->levels.at(i)
                                                  : plan_level(finer, cells, options.gated, crowd);
    if (plan.merges) {
      cells.crowd = plan.crowd;
      VoxelLevel& level = pyramid.levels.emplace_back();
      level.cell = cells.edge;
      level.voxels = merge_voxels(finer, cells);
      for (std::size_t v = 0; v < level.voxels.size(); ++v) {
        level.most_qq = std::max(level.most_qq, level.voxels[v].qq);
      }
      add_boxes(level);
    }
    pyramid.plan.push_back(plan);
    pyramid.level_of.push_back(pyramid.levels.size() - 1);
    stage.advance();
  }
}

}  // namespace pcednet::gls
