#include "pcednet/normals/exact_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "pcednet/normals/plane_fit.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kSeeds = 8;             ///< planes pass through two of these nearest
constexpr double kLeastSine = 0.3;            ///< between the directions to those two
constexpr double kTolerance = 0.003;          ///< over the distance to the last neighbour
constexpr int kLeastOnPlane = 5;              ///< neighbours, including the two
constexpr int kLeastOnSecond = 3;             ///< of these not on the first plane
constexpr double kLargestSecondCosine = 0.9;  ///< between the normals of the two planes

/// The neighbours of a point, relative to it.
struct Neighbourhood {
  std::array<Vec3, kExactNeighbours> offsets;
  std::size_t count = 0;
  double sq_radius = 0.0;
  double sq_tolerance = 0.0;  ///< of the distances to a plane
};

/// A plane through the point.
struct Plane {
  Vec3 normal = Vec3::Zero();
  std::uint32_t on_it = 0;  ///< a bit per neighbour
  double score = 0.0;

  int support() const { return std::popcount(on_it); }
  bool has(std::size_t neighbour) const { return (on_it >> neighbour & 1u) != 0; }
};

Plane plane_with(const Vec3& normal, const Neighbourhood& around) {
  Plane plane = {.normal = normal};
  const double sq_tolerance = around.sq_tolerance;
  for (std::size_t k = 0; k < around.count; ++k) {
    const double distance = normal.dot(around.offsets[k]), sq_distance = distance * distance;
    if (sq_distance >= sq_tolerance) continue;
    const double nearness = 1.0 - 0.5 * around.offsets[k].squaredNorm() / around.sq_radius;
    plane.on_it |= 1u << k;
    plane.score += (1.0 - sq_distance / sq_tolerance) * nearness;
  }
  return plane;
}

/// Whether the neighbours on the plane determine it.
bool is_determined(const Plane& plane, const Neighbourhood& around) {
  if (plane.support() < kLeastOnPlane) return false;
  Mat3 products = Mat3::Zero();
  for (std::size_t k = 0; k < around.count; ++k) {
    if (plane.has(k)) products += around.offsets[k] * around.offsets[k].transpose();
  }
  return fill_a_plane(products);
}

bool better(const Plane& a, const Plane& b) {
  return a.score < b.score;
}

/// The planes with enough neighbours on them.
struct Planes {
  std::array<Plane, kSeeds*(kSeeds - 1) / 2> all;
  std::size_t count = 0;
};

Planes planes_of(const Neighbourhood& around) {
  Planes planes;
  const std::size_t seeds = std::min(kSeeds, around.count);
  for (std::size_t a = 0; a < seeds; ++a) {
    for (std::size_t b = a + 1; b < seeds; ++b) {
      const Vec3 &u = around.offsets[a], &v = around.offsets[b], product = u.cross(v);
      const double sq_length = product.squaredNorm();
      if (!(sq_length > kLeastSine * kLeastSine * u.squaredNorm() * v.squaredNorm())) continue;
      const Plane plane = plane_with(product / std::sqrt(sq_length), around);
      if (is_determined(plane, around)) planes.all[planes.count++] = plane;
    }
  }
  return planes;
}

/// The positions of `neighbours`, and the planes through `point` within a fraction of the distance
/// to the last; planes with too few neighbours are left out.
Planes find_planes(std::span<const Vec3> points, std::size_t point,
                   std::span<const std::uint32_t> neighbours, double tolerance,
                   Neighbourhood& around) {
  around.count = std::min(neighbours.size(), kExactNeighbours);
  for (std::size_t k = 0; k < around.count; ++k) {
    around.offsets[k] = points[neighbours[k]] - points[point];
  }
  if (around.count < kExactNeighbours) return {};
  around.sq_radius = around.offsets[around.count - 1].squaredNorm();
  around.sq_tolerance = tolerance * tolerance * around.sq_radius;
  return planes_of(around);
}

/// The one with most neighbours, near ones with more weight; none if there are no planes.
const Plane* best_of(const Planes& planes) {
  const auto begin = planes.all.begin(), end = begin + static_cast<std::ptrdiff_t>(planes.count);
  return begin == end ? nullptr : &*std::max_element(begin, end, better);
}

/// The mean normal of the edge of two faces: all their points lie on one side of the plane across
/// it, where those of the other bisecting plane lie on both sides.
Vec3 mean_normal(const Plane& first, const Plane& second, const Neighbourhood& around) {
  const Vec3 sum = (first.normal + second.normal).normalized();
  const Vec3 difference = (first.normal - second.normal).normalized();
  double along_sum = 0.0, along_difference = 0.0;
  for (std::size_t k = 0; k < around.count; ++k) {
    if (!first.has(k) && !second.has(k)) continue;
    along_sum += sum.dot(around.offsets[k]);
    along_difference += difference.dot(around.offsets[k]);
  }
  return std::abs(along_sum) > std::abs(along_difference) ? sum : difference;
}

}  // namespace

bool fill_a_plane(const Mat3& products) {
  constexpr double kLeastRoundness = 0.25;  // 0 on a line, 1 all around the place
  const double trace = products.trace();
  const double of_pairs = 0.5 * (trace * trace - products.squaredNorm());
  return 4.0 * of_pairs >= kLeastRoundness * trace * trace;
}

Vec3 exact_normal(std::span<const Vec3> points, std::size_t point,
                  std::span<const std::uint32_t> neighbours) {
  Neighbourhood around;
  const Planes planes = find_planes(points, point, neighbours, kTolerance, around);
  const Plane* const best = best_of(planes);
  if (best == nullptr) return Vec3::Zero();
  const Plane& first = *best;
  const Plane* second = nullptr;
  for (const Plane& plane : std::span(planes.all).first(planes.count)) {
    if (std::abs(plane.normal.dot(first.normal)) > kLargestSecondCosine) continue;
    if (std::popcount(plane.on_it & ~first.on_it) < kLeastOnSecond) continue;
    if (second == nullptr || better(*second, plane)) second = &plane;
  }
  if (second != nullptr) return mean_normal(first, *second, around);

  std::vector<std::uint32_t> on_plane;
  for (std::size_t k = 0; k < around.count; ++k) {
    if (first.has(k)) on_plane.push_back(neighbours[k]);
  }
  const std::array<std::uint32_t, 1> some = {static_cast<std::uint32_t>(point)};
  std::array<PlaneFit, 1> fit;
  fit_planes(points, some, on_plane, fit);
  return fit[0].normal.isZero(0.0) ? first.normal : fit[0].normal;
}

bool is_on_face(std::span<const Vec3> points, std::size_t point,
                std::span<const std::uint32_t> neighbours) {
  Neighbourhood around;
  const Planes planes = find_planes(points, point, neighbours, kTolerance, around);
  const Plane* const face = best_of(planes);
  if (face == nullptr) return false;
  bool above = false, below = false;
  for (std::size_t k = 0; k < around.count; ++k) {
    if (face->has(k)) continue;
    const bool is_above = face->normal.dot(around.offsets[k]) > 0.0;
    (is_above ? above : below) = true;
  }
  return !(above && below);
}

Vec3 face_normal(std::span<const Vec3> points, std::size_t point,
                 std::span<const std::uint32_t> neighbours, double tolerance) {
  Neighbourhood around;
  const Planes planes = find_planes(points, point, neighbours, tolerance, around);
  const Plane* const best = best_of(planes);
  return best == nullptr ? Vec3(Vec3::Zero()) : best->normal;
}

}  // namespace pcednet::normals
