#include "pcednet/detect/exact_points.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "pcednet/normals/exact_planes.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kSamples = 2000, kNear = 12;
constexpr std::size_t kShare = 10;        ///< one in so many is on a plane
constexpr double kExactThickness = 1e-6;  ///< of a plane

/// The kNear points nearest to that of place `i` among those around it on the curve, without
/// copies; fewer if there are not enough.
std::vector<std::uint32_t> near_on_curve(std::span<const Vec3> positions,
                                         std::span<const std::uint32_t> curve, std::size_t i) {
  constexpr std::size_t kAround = 32;
  const Vec3& centre = positions[curve[i]];
  const auto sq_distance = [&](std::uint32_t point) {
    return (positions[point] - centre).squaredNorm();
  };
  std::vector<std::uint32_t> near;
  const std::size_t begin = i - std::min(i, kAround);
  for (std::size_t k = begin; k < std::min(i + kAround, curve.size()); ++k) {
    const Vec3& position = positions[curve[k]];
    const bool is_copy = k > begin && position == positions[curve[k - 1]];
    if (!is_copy && position != centre) near.push_back(curve[k]);
  }
  const std::size_t count = std::min(kNear, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                    [&](auto a, auto b) { return sq_distance(a) < sq_distance(b); });
  near.resize(count);
  return near;
}

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

}  // namespace

bool is_exact(std::span<const Vec3> positions, std::span<const std::uint32_t> curve) {
  const std::size_t samples = std::min(kSamples, curve.size());
  std::vector<std::uint32_t> some, neighbours;
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t i = s * curve.size() / samples;
    const auto near = near_on_curve(positions, curve, i);
    if (near.size() < kNear) continue;
    some.push_back(curve[i]);
    neighbours.insert(neighbours.end(), near.begin(), near.end());
  }
  std::vector<normals::PlaneFit> fits(some.size());
  normals::fit_planes(positions, some, neighbours, fits);
  std::size_t exact = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].normal.isZero(0.0) || fits[i].thickness >= kExactThickness) continue;
    const auto near = std::span<const std::uint32_t>(neighbours).subspan(kNear * i, kNear);
    exact += fill_a_plane(positions, near) ? 1 : 0;
  }
  return !fits.empty() && exact * kShare >= fits.size();
}

}  // namespace pcednet::detect
