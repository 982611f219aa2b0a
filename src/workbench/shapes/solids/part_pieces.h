#pragma once

#include "pcednet/core/random.h"
#include "workbench/shapes/solids/solid.h"

namespace pcednet::shapes {

// The pieces of parts. A frame places a piece in the part.

Eigen::Isometry3d at(const Vec3& place);

/// z along axis 0, 1 or 2.
Eigen::Isometry3d along(int axis, const Vec3& place);

bool chance(Random& random, double p);

/// Log-uniform between the bounds.
double size_between(Random& random, double low, double high);
std::size_t points_between(Random& random, double low, double high);

/// A unit vector of any direction.
Vec3 any_direction(Random& random);

CornerShape any_shape(Random& random);

/// x and y are half the side lengths.
Profile rectangle(double x, double y, CornerShape shape = CornerShape::kSharp, double size = 0.0);

Profile regular_polygon(int corners, double radius, double phase = 0.0);

/// A star-like outline of random corners about the origin, convex or not.
Profile random_outline(Random& random, double radius);

Volume prism(Profile profile, double half_height, const Eigen::Isometry3d& frame,
             CornerShape rim = CornerShape::kSharp, double rim_size = 0.0);

Volume turned(Profile profile, const Eigen::Isometry3d& frame);

Volume cylinder(double radius, double half_height, const Eigen::Isometry3d& frame,
                CornerShape rim = CornerShape::kSharp, double rim_size = 0.0);

/// x, y and z are half the side lengths.
Volume box(double x, double y, double z, const Vec3& place);

/// Cuts a hole of a common kind into a face at z = top, downwards.
void drill(Solid& part, Random& random, const Vec2& place, double radius, double top, double depth);

}  // namespace pcednet::shapes
