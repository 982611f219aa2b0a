#include "pcednet/detect/points/normal_fit.h"

#include <cmath>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/detect/points/near_on_curve.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kLeastFlat = 50;
constexpr double kThin = 0.05;        ///< thickness of a flat place
constexpr double kLeastCosine = 0.6;  ///< the mean of a place; 0.5 for random normals

}  // namespace

double share_of_misfits(std::span<const Vec3> positions, std::span<const Vec3> normals,
                        std::span<const std::uint32_t> curve, std::size_t count) {
  const NearOnCurve near = near_on_curve(positions, curve, count);
  std::vector<normals::PlaneFit> fits(near.points.size());
  normals::fit_planes(positions, near.points, near.neighbours, fits);
  std::size_t flat = 0, misfits = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].normal.isZero(0.0) || fits[i].thickness > kThin) continue;
    double cosines = 0.0, known = 0.0;
    for (const std::uint32_t other : near.of(i)) {
      if (!is_usable(normals[other])) continue;
      cosines += std::abs(normals[other].dot(fits[i].normal));
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
