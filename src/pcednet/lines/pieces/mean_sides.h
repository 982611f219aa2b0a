#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

namespace pcednet::lines {

/// Two directions across a curve, into the surfaces on its two sides.
using Sides = std::array<Eigen::Vector2d, 2>;

/// The mean directions of two sides, each pair of which may have them in either order; nothing if
/// they turn, so that a mean is shorter than `least`.
inline std::optional<Sides> mean_sides(std::span<const Sides> pairs, double least) {
  Sides sums = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  for (const auto& [a, b] : pairs) {
    const bool crossed = a.dot(sums[0]) + b.dot(sums[1]) < a.dot(sums[1]) + b.dot(sums[0]);
    sums[0] += crossed ? b : a;
    sums[1] += crossed ? a : b;
  }
  for (Eigen::Vector2d& sum : sums) {
    if (sum.norm() < least * static_cast<double>(pairs.size())) return std::nullopt;
    sum.normalize();
  }
  return sums;
}

}  // namespace pcednet::lines
