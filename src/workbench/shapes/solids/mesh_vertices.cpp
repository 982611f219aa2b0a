#include "workbench/shapes/solids/mesh_vertices.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/random.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {
namespace {

using spatial::KdTree;
using spatial::Neighbour;

std::vector<std::uint32_t> shuffled(std::size_t count, Random& random) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  random.shuffle(std::span(order));
  return order;
}

bool same_border(const BorderPoint& a, const BorderPoint& b) {
  return (a.a == b.a && a.b == b.b) || (a.a == b.b && a.b == b.a);
}

/// Walks along borders in steps of about `spacing`: the numbers of the points stepped on.
class BorderWalk {
 public:
  BorderWalk(std::span<const BorderPoint> borders, double spacing)
      : borders_(borders),
        tree_(positions_of(borders)),
        spacing_(spacing),
        free_(borders.size(), 1) {}

  std::vector<std::uint32_t> walk(Random& random) {
    for (const std::uint32_t start : shuffled(borders_.size(), random)) {
      if (!free_[start]) continue;
      take(start);
      for (int direction = 0; direction < 2; ++direction) {
        for (auto at = next(start); at != kNone; at = next(at)) take(at);
      }
    }
    return taken_;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  void take(std::uint32_t i) {
    taken_.push_back(i);
    tree_.within(borders_[i].position, 0.7 * spacing_, near_);
    for (const Neighbour& neighbour : near_) free_[neighbour.index] = 0;
  }

  /// The free point of the same border whose distance is nearest to the spacing.
  std::uint32_t next(std::uint32_t from) {
    tree_.within(borders_[from].position, 1.35 * spacing_, near_);
    std::uint32_t best = kNone;
    double least = spacing_;
    for (const Neighbour& neighbour : near_) {
      if (!free_[neighbour.index] || !same_border(borders_[neighbour.index], borders_[from]))
        continue;
      const double off = std::abs(std::sqrt(neighbour.sq_distance) - spacing_);
      if (off < least) least = off, best = neighbour.index;
    }
    return best;
  }

  std::span<const BorderPoint> borders_;
  KdTree tree_;
  double spacing_;
  std::vector<char> free_;
  std::vector<std::uint32_t> taken_;
  std::vector<Neighbour> near_;
};

/// The spacing wanted at each sample, as a multiple of that at borders.
std::vector<double> relative_spacing(const SolidSamples& samples, const KdTree& borders,
                                     std::size_t border_count, const Solid& solid,
                                     const MeshStyle& style, double spacing) {
  std::vector<double> relative;
  std::vector<Neighbour> nearest;
  for (const FacePoint& point : samples.points) {
    if (solid.is_curved(point.face)) {
      relative.push_back(style.curved_spacing);
      continue;
    }
    double away = 1e9;
    if (border_count > 0) {
      borders.nearest(point.position, 1, nearest);
      away = std::sqrt(nearest.front().sq_distance) / spacing;
    }
    relative.push_back(
        std::min(style.plane_limit, 1.0 + style.plane_growth * std::max(0.0, away - 1.0)));
  }
  return relative;
}

/// Points at random, none nearer to another than their spacing, fill 0.7 of their number squared.
constexpr double kFill = 0.7;

}  // namespace

MeshVertices mesh_vertices(const SolidSamples& samples, std::span<const BorderPoint> all_borders,
                           const Solid& solid, const MeshStyle& style, std::uint64_t seed) {
  Random random(seed, 77);
  std::vector<BorderPoint> borders;
  for (const BorderPoint& border : all_borders) {
    if (style.smooth_borders || border.turn() >= kSharpTurn) borders.push_back(border);
  }
  const KdTree border_tree(positions_of(borders));
  // The spacing at borders that makes the wanted number of points.
  double spacing = std::sqrt(kFill * samples.area / static_cast<double>(style.points));
  std::vector<double> relative;
  for (int i = 0; i < 4; ++i) {
    relative = relative_spacing(samples, border_tree, borders.size(), solid, style, spacing);
    double expected = 0.0;
    for (const double r : relative) expected += kFill / (r * r);
    expected *= samples.area / static_cast<double>(samples.points.size()) / (spacing * spacing);
    spacing *= std::sqrt(expected / static_cast<double>(style.points));
  }

  MeshVertices vertices;
  std::vector<char> free(samples.points.size(), 1);
  const KdTree tree(positions_of(samples.points));
  std::vector<Neighbour> near;
  const auto keep_away = [&](const Vec3& position, const Vec3& normal, double radius) {
    tree.within(position, radius, near);
    for (const Neighbour& neighbour : near) {
      // The far side of a thin wall has its own vertices.
      if (samples.points[neighbour.index].normal.dot(normal) > -0.3) free[neighbour.index] = 0;
    }
  };
  if (!borders.empty()) {
    for (const std::uint32_t i : BorderWalk(borders, spacing).walk(random)) {
      const BorderPoint& border = borders[i];
      vertices.positions.push_back(border.position);
      vertices.normals.push_back(border.normal());
      vertices.labels.push_back(border.turn() >= kSharpTurn ? kSharpEdge : kNonEdge);
      keep_away(border.position, border.normal(), 0.75 * spacing);
    }
  }
  for (const std::uint32_t i : shuffled(samples.points.size(), random)) {
    if (!free[i]) continue;
    const FacePoint& point = samples.points[i];
    vertices.positions.push_back(point.position);
    vertices.normals.push_back(point.normal);
    vertices.labels.push_back(kNonEdge);
    keep_away(point.position, point.normal, spacing * relative[i]);
  }
  return vertices;
}

}  // namespace pcednet::shapes
