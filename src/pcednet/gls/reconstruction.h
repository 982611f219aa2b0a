#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace pcednet::gls {

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

/// The reconstruction of that name; nothing for another name.
std::optional<Reconstruction> reconstruction_of(std::string_view name);

}  // namespace pcednet::gls
