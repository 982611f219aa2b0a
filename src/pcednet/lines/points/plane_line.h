#pragma once

#include <optional>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// The line in which two planes meet.
struct PlaneLine {
  Vec3 point;  ///< of the line, nearest to the origin
  Vec3 along;  ///< unit
};

/// The line in which the planes normal . x = distance meet, with unit normals; none if the sine of
/// their angle is below `least_sine`.
inline std::optional<PlaneLine> line_of_planes(const Vec3& normal_a, double distance_a,
                                               const Vec3& normal_b, double distance_b,
                                               double least_sine) {
  const double cosine = normal_a.dot(normal_b), sq_sine = 1.0 - cosine * cosine;
  if (sq_sine < least_sine * least_sine) return std::nullopt;
  const Vec3 point = ((distance_a - cosine * distance_b) * normal_a +
                      (distance_b - cosine * distance_a) * normal_b) /
                     sq_sine;
  return PlaneLine{point, normal_a.cross(normal_b).normalized()};
}

}  // namespace pcednet::lines
