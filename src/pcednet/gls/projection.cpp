#include "pcednet/gls/projection.h"

#include "pcednet/gls/sphere_fit.h"

namespace pcednet::gls {

Vec3 projection_move(const AlgebraicSphere& sphere) {
  const double length = sphere.ul.norm();
  return sphere.ul * (-2.0 * sphere.uc / (length * (length + sphere.pratt)));
}

double algebraic_distance(const AlgebraicSphere& sphere, const Vec3& y) {
  return (sphere.uc + sphere.ul.dot(y) + sphere.uq * y.squaredNorm()) / sphere.pratt;
}

}  // namespace pcednet::gls
