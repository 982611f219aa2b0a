#include "workbench/shapes/solids/solid_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {
namespace {

constexpr int kCells = 24;       // along the longest side of the box
constexpr double kShell = 0.08;  // of a cell: how far from the boundary points are drawn
constexpr double kOnSurface = 1e-9;

/// Moves `p` onto the boundary along the normals met on the way.
std::optional<FacePoint> onto_surface(const Solid& solid, Vec3 p) {
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const Solid::Value value = solid.value(p);
    const Vec3 normal = solid.normal_of(value.face, p);
    if (!normal.allFinite()) return std::nullopt;
    if (std::abs(value.distance) < kOnSurface) return FacePoint{p, normal, value.face};
    p -= value.distance * normal;
  }
  return std::nullopt;
}

/// The lower corners of the cells of `size` that the boundary may pass through.
std::vector<Vec3> cells_near(const Solid& solid, double size) {
  const BoundingBox& box = solid.box();
  const Vec3 extent = box.max - box.min + Vec3::Constant(size);
  std::array<int, 3> counts;
  for (int a = 0; a < 3; ++a)
    counts[static_cast<std::size_t>(a)] = static_cast<int>(std::ceil(extent[a] / size));
  const double reach = (0.5 * std::sqrt(3.0) + kShell) * size;
  std::vector<Vec3> cells;
  for (int x = 0; x < counts[0]; ++x) {
    for (int y = 0; y < counts[1]; ++y) {
      for (int z = 0; z < counts[2]; ++z) {
        const Vec3 low = box.min + size * Vec3(x - 0.5, y - 0.5, z - 0.5);
        const Vec3 centre = low + Vec3::Constant(0.5 * size);
        if (std::abs(solid.value(centre).distance) <= reach) cells.push_back(low);
      }
    }
  }
  return cells;
}

}  // namespace

double SolidSamples::spacing() const {
  return std::sqrt(area / static_cast<double>(points.size()));
}

double BorderPoint::turn() const {
  return std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
}

SolidSamples sample_solid(const Solid& solid, std::size_t count, std::uint64_t seed) {
  const double size = (solid.box().max - solid.box().min).maxCoeff() / kCells;
  const std::vector<Vec3> cells = cells_near(solid, size);
  constexpr std::size_t kBlock = 512, kTries = 1000;
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::vector<FacePoint>> parts(blocks);
  std::vector<std::size_t> tries(blocks);
  std::vector<std::size_t> hits(blocks);
  parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
    const std::size_t block = begin / kBlock;
    Random random(seed, block);
    const std::size_t most = kTries * (end - begin);
    while (!cells.empty() && parts[block].size() < end - begin && tries[block] < most) {
      ++tries[block];
      const Vec3 within = uniform_vector(random);
      const Vec3 p = cells[random.index(cells.size())] + size * within;
      if (std::abs(solid.value(p).distance) > kShell * size) continue;
      ++hits[block];
      const auto point = onto_surface(solid, p);
      if (!point) continue;
      // Straight onto a face; points beyond an edge would pile up on it.
      const Vec3 way = point->position - p;
      const Vec3 aside = way - way.dot(point->normal) * point->normal;
      if (aside.norm() < 1e-3 * kShell * size) parts[block].push_back(*point);
    }
  });
  SolidSamples samples;
  double all = 0.0, near = 0.0;
  for (std::size_t i = 0; i < blocks; ++i) {
    samples.points.insert(samples.points.end(), parts[i].begin(), parts[i].end());
    all += static_cast<double>(tries[i]), near += static_cast<double>(hits[i]);
  }
  if (samples.points.size() < count) {
    throw Error(ErrorKind::kFailure, "generated solid: no surface to draw points from");
  }
  const double volume = static_cast<double>(cells.size()) * size * size * size;
  samples.area = volume * near / all / (2.0 * kShell * size);
  return samples;
}

namespace {

/// The point between `a` and `b`, of different faces, where the face changes; none if the surface
/// is not continuous between them.
std::optional<BorderPoint> border_between(const Solid& solid, FacePoint a, FacePoint b) {
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const auto middle = onto_surface(solid, 0.5 * (a.position + b.position));
    if (!middle) return std::nullopt;
    if (middle->face == a.face) {
      a = *middle;
    } else {
      b = *middle;  // perhaps a third face, whose border with a is nearer
    }
    if ((a.position - b.position).norm() < 1e-8) break;
  }
  if (!((a.position - b.position).norm() < 1e-6)) return std::nullopt;
  BorderPoint border = {0.5 * (a.position + b.position), a.face, b.face, a.normal, b.normal};
  // Onto both surfaces by the shortest way, unless they touch without crossing.
  for (int i = 0; i < 4 && border.turn() > 0.02; ++i) {
    const double along = border.normal_a.dot(border.normal_b);
    const double fa = solid.distance_to(border.a, border.position);
    const double fb = solid.distance_to(border.b, border.position);
    const double scale = 1.0 / (1.0 - along * along);
    border.position -=
        scale * ((fa - along * fb) * border.normal_a + (fb - along * fa) * border.normal_b);
    border.normal_a = solid.normal_of(border.a, border.position);
    border.normal_b = solid.normal_of(border.b, border.position);
  }
  const bool stayed = (border.position - a.position).norm() < 1e-5;
  return stayed && std::abs(solid.value(border.position).distance) < 1e-7 ? std::optional(border)
                                                                          : std::nullopt;
}

/// A border point per sample that has a neighbour on another face; `find` gives the neighbours,
/// nearest first.
template <typename Find>
std::vector<BorderPoint> borders_by(const Solid& solid, std::span<const FacePoint> samples,
                                    const Find& find) {
  std::vector<std::optional<BorderPoint>> found(samples.size());
  parallel_blocks(samples.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      const FacePoint& point = samples[i];
      find(point.position, near);
      const auto other = std::find_if(near.begin(), near.end(), [&](const auto& neighbour) {
        const FacePoint& there = samples[neighbour.index];
        return there.face != point.face && there.normal.dot(point.normal) > -0.9;
      });
      if (other == near.end()) continue;
      found[i] = border_between(solid, point, samples[other->index]);
    }
  });
  std::vector<BorderPoint> borders;
  for (const auto& border : found) {
    if (border) borders.push_back(*border);
  }
  return borders;
}

}  // namespace

std::vector<BorderPoint> find_borders(const Solid& solid, const SolidSamples& samples) {
  const spatial::KdTree tree(positions_of(samples.points));
  const double reach = 1.5 * samples.spacing();
  return borders_by(solid, samples.points,
                    [&](const Vec3& position, auto& near) { tree.within(position, reach, near); });
}

std::vector<BorderPoint> borders_among(const Solid& solid, std::span<const Vec3> positions) {
  std::vector<std::optional<FacePoint>> moved(positions.size());
  parallel_blocks(positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) moved[i] = onto_surface(solid, positions[i]);
  });
  std::vector<FacePoint> points;
  for (const auto& point : moved) {
    if (point) points.push_back(*point);
  }
  const spatial::KdTree tree(positions_of(points));
  return borders_by(solid, points,
                    [&](const Vec3& position, auto& near) { tree.nearest(position, 13, near); });
}

}  // namespace pcednet::shapes
