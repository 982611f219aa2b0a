#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "pcednet/lines/exact/planes.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

inline constexpr std::uint32_t kNoPlane = std::numeric_limits<std::uint32_t>::max();

/// A point of one of two planes near a point of the other; or, if `b` is kNoPlane, a point of no
/// plane near one of `a`.
struct PlaneContact {
  std::uint32_t a, b;  ///< the planes, a < b
  std::uint32_t point;

  auto planes() const { return std::tie(a, b); }
  auto operator<=>(const PlaneContact&) const = default;  // NOLINT: no pointer; clang-tidy 14 errs
};

/// All contacts, each once, in the order of the planes, then of the points.
std::vector<PlaneContact> contacts_of(const OrderedPoints& cloud,
                                      const std::vector<PlanePatch>& planes, double spacing,
                                      const Progress* progress);

/// The contacts of each pair of planes, and of each plane with points of none.
struct ContactPairs {
  std::vector<std::span<const PlaneContact>> of_planes, of_free_points;
};

ContactPairs by_planes(const std::vector<PlaneContact>& contacts);

}  // namespace pcednet::lines
