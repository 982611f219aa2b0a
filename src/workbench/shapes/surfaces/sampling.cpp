#include "workbench/shapes/surfaces/sampling.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/prepare.h"
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

Vec3 plane_normal(std::span<const Vec3> positions, std::span<const spatial::Neighbour> near) {
  Vec3 mean = Vec3::Zero();
  for (const spatial::Neighbour& neighbour : near) mean += positions[neighbour.index];
  mean /= static_cast<double>(near.size());
  Mat3 covariance = Mat3::Zero();
  for (const spatial::Neighbour& neighbour : near) {
    const Vec3 offset = positions[neighbour.index] - mean;
    covariance += offset * offset.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors().col(0);
}

}  // namespace

SurfaceSamples sample_surface(const Shape& shape, const SampleOptions& options, Random& random) {
  constexpr std::size_t kSurplus = 8;
  if (options.min_distance <= 0.0) return draw(shape, options, options.points, random);
  return thinned(draw(shape, options, kSurplus * options.points, random), options);
}

void add_noise(std::span<Vec3> positions, double sigma, Random& random) {
  for (Vec3& position : positions) {
    for (int axis = 0; axis < 3; ++axis) position[axis] += sigma * random.normal();
  }
}

std::vector<std::size_t> displace_every_tenth(std::span<Vec3> positions, double reach,
                                              Random& random) {
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < positions.size(); i += 10) {
    positions[i] += Vec3::Constant(random.uniform(0.0, reach));
    moved.push_back(i);
  }
  return moved;
}

std::vector<Vec3> plane_normals(std::span<const Vec3> positions, std::size_t neighbours) {
  const spatial::KdTree tree(positions);
  std::vector<Vec3> normals(positions.size());
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(positions[i], neighbours, near);
      normals[i] = plane_normal(positions, near);
    }
  });
  return normals;
}

std::vector<Vec3> oriented_normals(std::span<const Vec3> positions) {
  return normals::estimate_oriented_normals(positions,
                                            {.choice = normals::choose_one_count(positions)})
      .normals;
}

std::vector<double> local_spacings(std::span<const Vec3> positions) {
  constexpr std::size_t kNeighbours = 11;      // the point itself among them
  constexpr double kSpacingsOfTheMean = 1.25;  // on a grid, to the ten nearest
  const spatial::KdTree tree(positions);
  std::vector<double> spacings(positions.size());
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(positions[i], kNeighbours, near);
      double sum = 0.0;
      for (const auto& neighbour : near) sum += std::sqrt(neighbour.sq_distance);
      spacings[i] = sum / (kSpacingsOfTheMean * static_cast<double>(kNeighbours - 1));
    }
  });
  return spacings;
}

}  // namespace pcednet::shapes
