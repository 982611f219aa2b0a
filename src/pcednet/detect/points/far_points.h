#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// Points with a larger coordinate may be of no place: values such as 1e30 stand for "no data".
constexpr double kSuspectCoordinate = 1e15;

/// The middle values of the coordinates of finite positions, of which there must be one.
Vec3 middle_of(std::span<const Vec3> positions);

/// The points that are far from all others, ascending: those with a coordinate above
/// kSuspectCoordinate that are farther from the middle of the others than 1e12 times the median
/// distance from it, as values are that stand for "no data". Distances to them would leave no
/// digits for the others.
std::vector<std::uint32_t> far_points(std::span<const Vec3> positions);

/// For the user, of one or more of them.
std::string note_on_far(std::span<const std::uint32_t> far, std::span<const Vec3> positions);

}  // namespace pcednet::detect
