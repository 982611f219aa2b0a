#include "pcednet/tiles/sample.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "pcednet/core/random.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/nearest.h"

namespace pcednet::tiles {
namespace {

/// The positions as they are described.
std::vector<Vec3> described(std::span<const Vec3> positions, const Plan& plan) {
  if (plan.normals.rounding.step > 0.0) return detect::spread(positions, plan.normals.rounding);
  return {positions.begin(), positions.end()};
}

/// The numbers of the positions in some boxes, or of all if hardly any is.
std::vector<std::size_t> places_in(std::span<const BoundingBox> boxes,
                                   std::span<const Vec3> positions) {
  constexpr std::size_t kFewInside = 1000;
  std::vector<std::size_t> inside(positions.size());
  std::iota(inside.begin(), inside.end(), std::size_t{0});
  const std::vector<std::size_t> all = inside;
  std::erase_if(inside, [&](std::size_t place) {
    return std::none_of(boxes.begin(), boxes.end(),
                        [&](const BoundingBox& box) { return box.holds(positions[place]); });
  });
  return inside.size() < kFewInside ? all : inside;
}

/// Mean distances to the nearest others of positions at equal steps of the sample.
std::vector<double> spacings_from(const SampledPoints& sample, const Plan& plan, CellCounts& counts,
                                  const Progress* progress) {
  const spatial::KdTree tree(sample.positions);
  const auto nearest = [&](std::size_t place) {
    std::vector<double> sq_distances(gls::kSpacingNeighbours);
    sq_distances.resize(tree.nearest(sample.positions[place], sq_distances));
    return sq_distances;
  };
  const std::size_t points = sample.positions.size();
  if (sample.is_all) {
    const std::vector<std::size_t> places = places_in(sample.inner, sample.positions);
    return gls::sampled_spacings(places.size(), [&](std::size_t place) {
      return gls::mean_distance(nearest(places[place]));
    });
  }
  const auto reach = gls::sampled_spacings(
      points, [&](std::size_t place) { return std::sqrt(nearest(place).back()) * (1.0 + 1e-12); });
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    places.push_back(sample.positions[i * points / reach.size()]);
  }
  NearestInStream stream(std::move(places), reach);
  stream_points(plan, "spacing", progress, [&](std::span<const Vec3> positions) {
    stream.add(described(positions, plan));
    counts.add(positions);
  });
  std::vector<double> spacings;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    spacings.push_back(gls::mean_distance(stream.of(i)));
  }
  return spacings;
}

}  // namespace

void stream_points(const Plan& plan, const char* stage, const Progress* progress,
                   const std::function<void(std::span<const Vec3>)>& see) {
  Stage steps(progress, stage, plan.points());
  for (const PlannedInput& input : plan.inputs) {
    const auto use = [&](const PointCloud& part, std::size_t) {
      see(part.positions);
      steps.advance(part.size());
    };
    for_each_chunk(
        input, [](const Chunk&) { return true; }, progress, use);
  }
}

void Sample::add(std::span<const Vec3> positions) {
  for (const Vec3& position : positions) {
    if (!has_place(position)) continue;
    const std::uint64_t number = Random(1, seen_++).next();
    if (number > limit_) continue;
    chosen_.emplace_back(number, position);
    if (chosen_.size() >= 2 * most_) keep_smallest();
  }
}

void Sample::keep_smallest() {
  if (chosen_.size() <= most_) return;
  const auto end = chosen_.begin() + static_cast<std::ptrdiff_t>(most_);
  std::nth_element(chosen_.begin(), end - 1, chosen_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  limit_ = (end - 1)->first;
  chosen_.erase(end, chosen_.end());
}

std::vector<Vec3> Sample::take() {
  keep_smallest();
  std::vector<Vec3> positions;
  positions.reserve(chosen_.size());
  for (const auto& [number, position] : chosen_) positions.push_back(position);
  std::vector<std::pair<std::uint64_t, Vec3>>().swap(chosen_);
  return spatial::in_order(positions, spatial::curve_order(positions));
}

Spacing find_spacing(const SampledPoints& sample, const Plan& plan, const gls::ScaleRange& given,
                     CellCounts& counts, const Progress* progress) {
  std::vector<Vec3> positions = described(sample.positions, plan);
  if (plan.normals.rounding.step > 0.0) {
    positions = spatial::in_order(positions, spatial::curve_order(positions));
  }
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  std::vector<double> spacings =
      spacings_from({positions, sample.is_all, sample.inner}, plan, counts, progress);
  if (!sample.is_all) positions.insert(positions.end(), {plan.box.min, plan.box.max});
  Spacing spacing{.range = gls::scale_range(positions, given, [&] { return spacings; })};
  std::vector<double> sorted = spacings;
  std::sort(sorted.begin(), sorted.end());
  if (!sorted.empty()) spacing.median = sorted[sorted.size() / 2];
  if (!sorted.empty()) spacing.wide = sorted[(sorted.size() - 1) - sorted.size() / 1000];
  return spacing;
}

}  // namespace pcednet::tiles
