#include "pcednet/detect/normal_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/eigendecomposition.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kPlaces = 1000, kLeastFlat = 50;
constexpr std::size_t kPoints = 24;          ///< of a place, one after another on the curve
constexpr double kThin = 0.05, kWide = 0.1;  ///< variances of a flat place over the next
constexpr double kLeastCosine = 0.6;         ///< the mean of a place; 0.5 for random normals

/// The normal of the plane of the points; none if they are not flat.
std::optional<Vec3> plane_normal(std::span<const Vec3> positions,
                                 std::span<const std::uint32_t> points) {
  const Vec3 first = positions[points.front()];
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t i : points) sum += positions[i] - first;
  const Vec3 mean = first + sum / static_cast<double>(points.size());
  Mat3 products = Mat3::Zero();
  for (const std::uint32_t i : points) {
    const Vec3 offset = positions[i] - mean;
    products += offset * offset.transpose();
  }
  if (!(products.trace() > 0.0) || !std::isfinite(products.trace())) return std::nullopt;
  const auto [variances, axes] = eigendecomposition(products / products.trace());
  if (variances[0] > kThin * variances[1] || variances[1] < kWide * variances[2]) {
    return std::nullopt;
  }
  return axes.col(0);
}

}  // namespace

double share_of_misfits(std::span<const Vec3> positions, std::span<const Vec3> normals,
                        std::span<const std::uint32_t> curve) {
  if (curve.size() < kPoints) return 0.0;
  std::size_t flat = 0, misfits = 0;
  const std::size_t step = std::max(kPoints, curve.size() / kPlaces);
  for (std::size_t begin = 0; begin + kPoints <= curve.size(); begin += step) {
    const auto points = curve.subspan(begin, kPoints);
    const auto normal = plane_normal(positions, points);
    if (!normal) continue;
    double cosines = 0.0, known = 0.0;
    for (const std::uint32_t i : points) {
      if (!is_usable(normals[i])) continue;
      cosines += std::abs(normals[i].dot(*normal));
      known += 1.0;
    }
    if (known == 0.0) continue;
    ++flat;
    misfits += cosines < kLeastCosine * known;
  }
  if (flat < kLeastFlat) return 0.0;
  return static_cast<double>(misfits) / static_cast<double>(flat);
}

}  // namespace pcednet::detect
