#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/lines/exact/fold_search.h"
#include "pcednet/lines/exact/planes.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Which planes have points near each other.
class PlaneNeighbours {
 public:
  PlaneNeighbours(std::size_t planes, std::span<const std::span<const PlaneContact>> pairs);

  /// The planes near both, ascending.
  std::vector<std::uint32_t> of_both(std::uint32_t a, std::uint32_t b) const;

 private:
  std::vector<std::vector<std::uint32_t>> of_planes_;  ///< ascending
};

/// The places near a pair of planes where one of `others` meets both, and all three have a point
/// nearby.
std::vector<Vec3> vertices_of(const OrderedPoints& cloud, const std::vector<PlanePatch>& planes,
                              std::span<const PlaneContact> pair,
                              std::span<const std::uint32_t> others, double spacing);

}  // namespace pcednet::lines
