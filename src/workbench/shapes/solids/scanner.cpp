#include "workbench/shapes/solids/scanner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {
namespace {

constexpr double kLeaf = 0.04;  // half the width of a leaf

// Two hits are on one surface if they are nearer than so many gaps between rays there.
constexpr double kJump = 2.0;
constexpr double kSlant = 0.1;     // the least cosine between ray and normal that counts
constexpr std::size_t kAhead = 2;  // rays without the surface where it ends

struct Hit {
  double distance = 0.0;  ///< 0: nothing
  bool leaf = false;

  bool on_solid() const { return distance > 0.0 && !leaf; }
};

/// Sphere tracing: the solid's distance, and that to the next leaf, are steps that miss nothing.
Hit trace(const Scene& scene, const spatial::KdTree& foliage, const Vec3& from,
          const Vec3& direction, double range) {
  double t = 0.3;
  std::vector<spatial::Neighbour> near;
  for (int i = 0; i < 200 && t < range; ++i) {
    const Vec3 p = from + t * direction;
    const double solid = scene.solid.value(p).distance;
    double step = solid;
    if (!scene.foliage.empty()) {
      foliage.nearest(p, 1, near);
      const double leaf = std::sqrt(near.front().sq_distance) - kLeaf;
      if (leaf < 1e-3 && leaf <= solid) return {t, true};
      step = std::min(step, leaf);
    }
    if (solid < 1e-4) return {t, false};
    t += std::max(step, 5e-5);
  }
  return {};
}

/// Directions at equal angles over a window of 120 by 100 degrees about `towards`.
struct Rays {
  std::vector<Vec3> directions;  ///< column by column
  std::size_t rows;

  std::size_t columns() const { return directions.size() / rows; }
};

Rays rays_of(const ScanPlace& place, std::size_t rays) {
  const double wide = 120.0, high = 100.0;
  const auto columns = static_cast<std::size_t>(std::sqrt(static_cast<double>(rays) * wide / high));
  const std::size_t rows = rays / columns;
  const Vec3 forward = (place.towards - place.position).normalized();
  const double yaw = std::atan2(forward.y(), forward.x()), pitch = std::asin(forward.z());
  Rays result = {{}, rows};
  const double degree = std::numbers::pi / 180.0;
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t r = 0; r < rows; ++r) {
      const double a =
          yaw +
          wide * degree * ((static_cast<double>(c) + 0.5) / static_cast<double>(columns) - 0.5);
      const double b =
          pitch +
          high * degree * ((static_cast<double>(r) + 0.5) / static_cast<double>(rows) - 0.5);
      result.directions.emplace_back(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a),
                                     std::sin(b));
    }
  }
  return result;
}

/// What one scanner sees of the solid.
struct Outlook {
  Vec3 from;
  Rays rays;
  std::vector<Hit> hits = {};
  std::vector<Vec3> normals = {};  ///< of the solid where it is hit

  Vec3 at(std::size_t r) const { return from + hits[r].distance * rays.directions[r]; }
  /// The distance to the hit of a ray at this angle, on the plane that touches the surface.
  double gap(std::size_t r, double angle) const {
    const double cosine = std::abs(normals[r].dot(rays.directions[r]));
    return hits[r].distance * angle / std::max(cosine, kSlant);
  }
  bool on_one_surface(std::size_t r, std::size_t other) const {
    if (!hits[other].on_solid()) return false;
    const double angle = (rays.directions[other] - rays.directions[r]).norm();
    return (at(other) - at(r)).norm() < kJump * std::max(gap(r, angle), gap(other, angle));
  }
  /// See Scan::open_sides.
  Vec3 open_side(std::size_t r) const;
};

Vec3 Outlook::open_side(std::size_t r) const {
  const std::size_t row = r % rays.rows, column = r / rays.rows;
  const struct {
    std::size_t step, before, after;  // between rays, and their number on either side
  } lines[] = {{1, row, rays.rows - 1 - row}, {rays.rows, column, rays.columns() - 1 - column}};
  Vec3 open = Vec3::Zero(), first = Vec3::Zero();
  for (const auto& line : lines) {
    for (const bool forward : {false, true}) {
      const std::size_t ahead = forward ? line.after : line.before;
      const auto ray = [&](std::size_t k) {
        return forward ? r + k * line.step : r - k * line.step;
      };
      bool goes_on = false;
      for (std::size_t k = 1; k <= std::min(ahead, kAhead); ++k) {
        goes_on = goes_on || on_one_surface(r, ray(k));
      }
      if (goes_on) continue;
      const std::size_t last = forward ? r - line.step : r + line.step;
      const Vec3 side = ahead > 0 ? rays.directions[ray(1)] - rays.directions[r]
                                  : rays.directions[r] - rays.directions[last];
      if (first.isZero(0.0)) first = side;
      open += side;
    }
  }
  if (first.isZero(0.0)) return first;
  if (open.norm() < 0.5 * first.norm()) open = first;  // opposite sides
  const Vec3 within = open - open.dot(normals[r]) * normals[r];
  return within.norm() > kSlant * open.norm() ? within : open;
}

Outlook look(const Scene& scene, const spatial::KdTree& foliage, const ScanPlace& place,
             const ScannerOptions& options) {
  Outlook view = {.from = place.position, .rays = rays_of(place, options.rays)};
  const std::vector<Vec3>& directions = view.rays.directions;
  view.hits.resize(directions.size());
  view.normals.resize(directions.size());
  parallel_blocks(directions.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      view.hits[r] = trace(scene, foliage, view.from, directions[r], options.range);
      if (!view.hits[r].on_solid()) continue;
      const Vec3 hit = view.at(r);
      view.normals[r] = scene.solid.normal_of(scene.solid.value(hit).face, hit);
    }
  });
  return view;
}

}  // namespace

Scan scan_scene(const Scene& scene, const ScannerOptions& options, std::uint64_t seed) {
  const spatial::KdTree foliage(scene.foliage);
  Scan scan;
  Random random(seed, 31);
  for (std::size_t i = 0; i < std::min(options.places, scene.scanners.size()); ++i) {
    const ScanPlace& place = scene.scanners[i];
    const Outlook view = look(scene, foliage, place, options);
    const std::vector<Vec3>& directions = view.rays.directions;
    const std::vector<Hit>& hits = view.hits;
    std::vector<Vec3> open_sides(directions.size(), Vec3::Zero());
    parallel_blocks(directions.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r) {
        if (hits[r].on_solid()) open_sides[r] = view.open_side(r);
      }
    });
    const double shift = i == 0 ? 0.0 : options.misalignment;
    const Vec3 offset = shift * normal_vector(random).cwiseProduct(Vec3(1.0, 1.0, 0.5));
    for (std::size_t r = 0; r < directions.size(); ++r) {
      if (hits[r].distance == 0.0) continue;
      double distance = hits[r].distance;
      ReturnKind kind = hits[r].leaf ? ReturnKind::kLeaf : ReturnKind::kSolid;
      for (const std::size_t back : {std::size_t{1}, view.rays.rows}) {
        const double before = r >= back ? hits[r - back].distance : 0.0;
        const bool jumps = before > 0.0 && std::abs(before - hits[r].distance) > 0.1;
        if (!jumps || kind == ReturnKind::kStray || random.uniform() >= options.mixed) continue;
        distance += random.uniform() * (before - distance);
        kind = ReturnKind::kStray;
      }
      if (random.uniform() < options.outliers) {
        distance *= random.uniform(0.3, 1.2);
        kind = ReturnKind::kStray;
      }
      distance += options.range_noise * random.normal();
      scan.positions.push_back(place.position + distance * directions[r] + offset);
      scan.kinds.push_back(kind);
      scan.places.push_back(static_cast<std::uint8_t>(i));
      scan.open_sides.push_back(open_sides[r]);
    }
  }
  return scan;
}

}  // namespace pcednet::shapes
