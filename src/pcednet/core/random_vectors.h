#pragma once

#include "pcednet/core/random.h"
#include "pcednet/core/vec3.h"

/// Random vectors, whose numbers are drawn one after another. In the arguments of a call at most
/// one number is drawn: the compiler may evaluate them in any order, and every compiler must
/// generate the same clouds.
namespace pcednet {

/// In the box between the corners: the unit cube if none are given.
inline Vec3 uniform_vector(Random& random, const Vec3& low = Vec3::Zero(),
                           const Vec3& high = Vec3::Ones()) {
  const double z = random.uniform(low.z(), high.z());
  const double y = random.uniform(low.y(), high.y());
  const double x = random.uniform(low.x(), high.x());
  return {x, y, z};
}

/// Three independent normal numbers.
inline Vec3 normal_vector(Random& random) {
  const double z = random.normal();
  const double y = random.normal();
  const double x = random.normal();
  return {x, y, z};
}

}  // namespace pcednet
