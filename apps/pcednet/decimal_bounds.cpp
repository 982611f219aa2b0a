#include "decimal_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcednet::app {
namespace {

constexpr int kMostDecimals = 12;

/// The decimals of a number; none if it has more than kMostDecimals.
std::optional<int> decimals_of(double number) {
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
    const double shifted = number * std::pow(10.0, decimals);
    if (std::abs(shifted - std::round(shifted)) <= 1e-12 * std::abs(shifted)) return decimals;
  }
  return std::nullopt;
}

}  // namespace

BoundingBox decimal_bounds(const formats::CloudFacts& facts) {
  BoundingBox bounds = facts.bounds;
  if (!facts.las || bounds.empty()) return bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto of_scale = decimals_of(facts.las->scale[a]);
    const auto of_offset = decimals_of(facts.las->offset[a]);
    if (!of_scale || !of_offset) continue;
    const double power = std::pow(10.0, std::max(*of_scale, *of_offset));
    for (Vec3* corner : {&bounds.min, &bounds.max}) {
      (*corner)[axis] = std::round((*corner)[axis] * power) / power;
    }
  }
  return bounds;
}

}  // namespace pcednet::app
