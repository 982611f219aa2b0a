#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/scales.h"

namespace pcednet::tiles {

/// The exact nearest places of points to given ones, in a stream of points that is never stored:
/// copies of a point count once.
class NearestInStream {
 public:
  /// `reach`: a distance within which each place has its nearest ones.
  NearestInStream(std::vector<Vec3> places, std::span<const double> reach);

  void add(std::span<const Vec3> points);

  /// The squared distances of the nearest ones to a place, ascending; infinite where there are
  /// fewer.
  std::span<const double> of(std::size_t place) const { return nearest_[place]; }

 private:
  using Row = std::array<double, gls::kSpacingNeighbours>;
  struct Found {
    std::uint32_t place;
    double sq_distance;
    Vec3 point;
  };
  struct Cell {
    int size;  ///< its edge is 2^size
    std::array<std::int64_t, 3> place;
    bool operator==(const Cell&) const = default;
  };
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };
  void look_around(const Vec3& point, std::vector<Found>& found) const;
  void insert(const Found& found);

  std::vector<Vec3> places_;
  std::vector<double> sq_reach_;
  std::vector<Row> nearest_;
  std::vector<std::array<Vec3, gls::kSpacingNeighbours>> points_;  ///< at these distances
  std::vector<int> sizes_ = {};  ///< of the cells in use, as powers of two
  std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells_ = {};
};

}  // namespace pcednet::tiles
