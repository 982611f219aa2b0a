#pragma once

#include <algorithm>
#include <cmath>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/lines/points/moments.h"

namespace pcednet::lines {

/// Sums over points about an origin near them.
struct PlaneSums {
  Vec3 origin = Vec3::Zero();
  PointMoments moments = {};

  void add(const Vec3& place) { moments.add(place - origin); }
  double count() const { return moments.weight; }
};

/// A plane of least squares.
struct FittedPlane {
  Vec3 point, normal;
  double residual, width;  ///< standard deviations across it, and along its shorter side
};

inline FittedPlane fit_plane(const PlaneSums& sums) {
  const auto [variances, axes] = eigendecomposition(sums.moments.covariance());
  return {sums.origin + sums.moments.mean(), axes.col(0).normalized(),
          std::sqrt(std::max(variances[0], 0.0)), std::sqrt(std::max(variances[1], 0.0))};
}

}  // namespace pcednet::lines
