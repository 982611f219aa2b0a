#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace pcednet::spatial {

/// The side of the square that holds one point of a surface, if the nearest `points` points, the
/// one itself among them, are within this squared distance of it.
inline double side_of_square(double sq_distance, std::size_t points) {
  return std::sqrt(std::numbers::pi * sq_distance / static_cast<double>(points));
}

}  // namespace pcednet::spatial
