#include "pcednet/gls/projection.h"
#include "pcednet/gls/sphere_fit.h"

#include <array>

namespace pcednet::gls {

std::span<const std::string_view> reconstruction_names() {
  static constexpr std::array<std::string_view, 4> kNames = {"covariance-plane", "plane-mls",
                                                             "sphere", "sphere-mls"};
  return kNames;
}

std::string_view name_of(Reconstruction reconstruction) {
  return reconstruction_names()[static_cast<std::size_t>(reconstruction)];
}

Vec3 projection_move(const AlgebraicSphere& sphere) {
  const double length = sphere.ul.norm();
  return sphere.ul * (-2.0 * sphere.uc / (length * (length + sphere.pratt)));
}

double algebraic_distance(const AlgebraicSphere& sphere, const Vec3& y) {
  return (sphere.uc + sphere.ul.dot(y) + sphere.uq * y.squaredNorm()) / sphere.pratt;
}

}  // namespace pcednet::gls
