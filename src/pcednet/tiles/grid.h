#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/points/far_points.h"

namespace pcednet::tiles {

/// Whether a point is somewhere: finite, and no value that stands for "no data".
inline bool has_place(const Vec3& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= detect::kSuspectCoordinate;
}

/// The positions, NaN for those without a place.
inline std::vector<Vec3> places_of(std::span<const Vec3> positions) {
  std::vector<Vec3> places(positions.begin(), positions.end());
  for (Vec3& place : places) {
    if (!has_place(place)) place.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return places;
}

/// The cores of tiles: squares of the plane of x and y, as high as the cloud, at multiples of their
/// length. Half-open, so that a point is in exactly one.
///
/// A core consists of `across` x `across` cells of length `cell`; the cells decide, with one
/// rounding, which core a point is in, never the core's own edges.
struct Grid {
  double cell = 1.0;
  std::int64_t across = 1;

  double length() const { return cell * static_cast<double>(across); }

  /// Column and row of the cell that holds a point.
  std::array<std::int64_t, 2> cell_of(const Vec3& position) const {
    return {floor_of(position.x()), floor_of(position.y())};
  }

  /// Column and row of the core that holds a point, which must have a place.
  std::array<std::int64_t, 2> core_of(const Vec3& position) const {
    const auto [x, y] = cell_of(position);
    return {core_of_cell(x), core_of_cell(y)};
  }
  std::int64_t core_of_cell(std::int64_t index) const {
    return index >= 0 ? index / across : -((across - 1 - index) / across);
  }

  double edge(std::int64_t core) const { return static_cast<double>(core) * length(); }

 private:
  std::int64_t floor_of(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / cell));
  }
};

}  // namespace pcednet::tiles
