#pragma once

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

struct AlgebraicSphere;

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
