#include "workbench/shapes/sampling.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {
namespace {

constexpr std::size_t kTriesPerPoint = 1000;

/// Draws a patch with a chance proportional to its largest density, a point of it uniformly in
/// (u, v), and keeps it with the chance density / largest: uniform by area over all patches.
SurfaceSamples draw(const Shape& shape, const SampleOptions& options, std::size_t count,
                    Random& random) {
  std::vector<double> ends;
  double total = 0.0;
  for (const SurfacePatch& patch : shape.patches) ends.push_back(total += patch.max_density);
  SurfaceSamples samples;
  for (std::size_t tries = 0; samples.positions.size() < count; ++tries) {
    if (tries == kTriesPerPoint * count) {
      throw Error(ErrorKind::kFailure, "generated shape: no surface to draw points from");
    }
    const auto end = std::upper_bound(ends.begin(), ends.end() - 1, random.uniform() * total);
    const SurfacePatch& patch = shape.patches[static_cast<std::size_t>(end - ends.begin())];
    const double u = random.uniform();
    const SurfacePoint point = patch.at(u, random.uniform());
    if (point.density > patch.max_density * (1.0 + 1e-9)) {
      throw Error(ErrorKind::kFailure, fmt::format("generated shape: density {} above bound {}",
                                                   point.density, patch.max_density));
    }
    if (random.uniform() * patch.max_density >= point.density) continue;
    if (options.keep && random.uniform() >= options.keep(point.position)) continue;
    samples.positions.push_back(point.position);
    samples.normals.push_back(point.normal);
  }
  return samples;
}

/// The first `options.points` samples that keep their distance from all kept before them.
SurfaceSamples thinned(const SurfaceSamples& samples, const SampleOptions& options) {
  const spatial::KdTree tree(samples.positions);
  std::vector<bool> dropped(samples.positions.size());
  std::vector<spatial::Neighbour> near;
  SurfaceSamples kept;
  for (std::size_t i = 0; i < dropped.size() && kept.positions.size() < options.points; ++i) {
    if (dropped[i]) continue;
    tree.within(samples.positions[i], options.min_distance, near);
    for (const spatial::Neighbour& neighbour : near) dropped[neighbour.index] = true;
    kept.positions.push_back(samples.positions[i]);
    kept.normals.push_back(samples.normals[i]);
  }
  if (kept.positions.size() < options.points) {
    throw Error(ErrorKind::kFailure,
                fmt::format("generated shape: room for {} points of {} at distance {}",
                            kept.positions.size(), options.points, options.min_distance));
  }
  return kept;
}

}  // namespace

SurfaceSamples sample_surface(const Shape& shape, const SampleOptions& options, Random& random) {
  constexpr std::size_t kSurplus = 8;
  if (options.min_distance <= 0.0) return draw(shape, options, options.points, random);
  return thinned(draw(shape, options, kSurplus * options.points, random), options);
}

}  // namespace pcednet::shapes
