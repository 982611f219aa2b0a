#pragma once

#include <span>
#include <string_view>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

struct AlgebraicSphere;

/// The surface whose geometry is described.
enum class Reconstruction {
  kCovariancePlane,  ///< plane of the neighbours' covariance, where the point lies
  kPlaneMls,   ///< the same, after moving the point onto it (Alexa et al. 2001, no polynomial)
  kSphere,     ///< algebraic sphere, where the point lies
  kSphereMls,  ///< the same, after moving the point onto it (APSS)
};

constexpr bool projects(Reconstruction reconstruction) {
  return reconstruction == Reconstruction::kPlaneMls ||
         reconstruction == Reconstruction::kSphereMls;
}

constexpr bool fits_spheres(Reconstruction reconstruction) {
  return reconstruction == Reconstruction::kSphere || reconstruction == Reconstruction::kSphereMls;
}

/// Their names in files and on the command line, in the order of the enum.
std::span<const std::string_view> reconstruction_names();
std::string_view name_of(Reconstruction reconstruction);

/// The vector from the evaluation point to the nearest point of the sphere,
///
///     x' - x = -2 uc / (|ul| (|ul| + pratt)) ul,
///
/// exact for spheres and for planes (uq = 0). |ul| must not be 0.
Vec3 projection_move(const AlgebraicSphere& sphere);

/// The normalised value of the sphere at y, relative to its evaluation point: the signed algebraic
/// distance (uc + ul.y + uq |y|^2) / pratt.
double algebraic_distance(const AlgebraicSphere& sphere, const Vec3& y);

}  // namespace pcednet::gls
