#include "pcednet/detect/points/exact_points.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "pcednet/detect/points/near_on_curve.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kShare = 10;       ///< one in so many is on a plane
constexpr std::size_t kShareInRows = 2;  ///< and one in so many in a row of a grid
constexpr double kSineInRow = 1e-3;      ///< of two others, seen from a point in their row

/// Whether these, which lie on a plane, fill it about their mean.
bool fill_a_plane(std::span<const Vec3> positions, std::span<const std::uint32_t> points) {
  Vec3 mean = Vec3::Zero();
  for (const std::uint32_t i : points) mean += positions[i];
  mean /= static_cast<double>(points.size());
  Mat3 products = Mat3::Zero();
  for (const std::uint32_t i : points) {
    const Vec3 offset = positions[i] - mean;
    products += offset * offset.transpose();
  }
  return normals::fill_a_plane(products);
}

/// Whether two of these are on one line with the place.
bool is_in_row(const Vec3& place, std::span<const Vec3> positions,
               std::span<const std::uint32_t> points) {
  for (std::size_t a = 0; a < points.size(); ++a) {
    const Vec3 u = positions[points[a]] - place;
    for (std::size_t b = 0; b < a; ++b) {
      const Vec3 v = positions[points[b]] - place;
      const double sq_most = kSineInRow * kSineInRow * u.squaredNorm() * v.squaredNorm();
      if (u.cross(v).squaredNorm() < sq_most) return true;
    }
  }
  return false;
}

}  // namespace

bool is_exact(std::span<const Vec3> positions, std::span<const std::uint32_t> curve) {
  const NearOnCurve near = near_on_curve(positions, curve);
  std::vector<normals::PlaneFit> fits(near.points.size());
  normals::fit_planes(positions, near.points, near.neighbours, fits);
  std::size_t exact = 0, in_rows = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    in_rows += is_in_row(positions[near.points[i]], positions, near.of(i)) ? 1 : 0;
    if (fits[i].normal.isZero(0.0) || fits[i].thickness >= kExactThickness) continue;
    exact += fill_a_plane(positions, near.of(i)) ? 1 : 0;
  }
  return exact * kShare >= fits.size() && in_rows * kShareInRows < fits.size();
}

}  // namespace pcednet::detect
