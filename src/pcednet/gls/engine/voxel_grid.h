#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "pcednet/gls/engine/voxel_merge.h"
#include "pcednet/spatial/morton.h"
#include "pcednet/spatial/radix_sort.h"

namespace pcednet::gls {

// Bits of a key below the place of a cell, and of cubes of 4 and 8 cells a side.
inline constexpr int kAxisBits = 2, kGatedBits = kAxisBits + 6, kBlockBits = kAxisBits + 9;
// A block is this many cells a side, and where it is merged further, this many voxels.
inline constexpr std::uint64_t kBlockCells = 8, kBlockVoxels = 3;

inline std::size_t dominant_axis(const MeanNormal& n) {
  const float x = std::abs(n[0]), y = std::abs(n[1]), z = std::abs(n[2]);
  return x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
}

/// The cells of a level. Keys distinguish 2^20 cells along an axis, a cube; where there are more
/// (points far from all others), cells with equal keys are compared themselves, and cubes follow a
/// curve.
class VoxelGrid {
 public:
  VoxelGrid(VoxelSpan voxels, const MergeCells& cells)
      : voxels_(voxels),
        origin_(cells.origin),
        inverse_edge_(1.0 / cells.edge),
        cells_along_(cells.side * inverse_edge_ + 1.0) {}

  /// The cell's place on the curve, then the axis of the normal.
  std::uint64_t key(std::size_t i) const {
    const std::array<std::uint64_t, 3> cell = cell_of(i);
    const auto wrapped = [&](std::size_t a) { return static_cast<std::uint32_t>(cell[a] & kMost); };
    const std::uint64_t place = spatial::morton_code({wrapped(0), wrapped(1), wrapped(2)});
    return place << kAxisBits | dominant_axis(voxels_.normal(i));
  }

  bool has_cubes() const { return cells_along_ >= static_cast<double>(kMost); }
  /// The place of the cell's cube on the curve.
  std::uint64_t cube(std::size_t i) const {
    std::array<std::uint32_t, 3> cube;
    for (std::size_t a = 0; a < 3; ++a) {
      cube[a] = static_cast<std::uint32_t>(std::min(cell_of(i)[a] >> kCubeBits, kMostCubes));
    }
    return spatial::morton_code(cube);
  }

  /// The voxel within its block, if that is merged further.
  std::size_t place_in_block(std::size_t i) const {
    constexpr double kPerCell = static_cast<double>(kBlockVoxels) / kBlockCells;
    std::size_t place = 0;
    for (const double c : place_of(i)) {
      const double offset = c - std::floor(c / kBlockCells) * kBlockCells;
      place = place * kBlockVoxels + static_cast<std::size_t>(offset * kPerCell);
    }
    return place;
  }

  int key_bits() const {
    return kAxisBits + 3 * std::bit_width(static_cast<std::uint64_t>(
                               std::min(cells_along_, static_cast<double>(kMost))));
  }

  /// True if the keys of two voxels differ in their lowest `bits` bits only, and their cells
  /// accordingly.
  bool are_together(const spatial::Keyed& i, const spatial::Keyed& j, int bits) const {
    if (i.key >> bits != j.key >> bits) return false;
    if (!has_cubes()) return true;
    const std::array<std::uint64_t, 3> a = cell_of(i.index), b = cell_of(j.index);
    const int shift = (bits - kAxisBits) / 3;
    return a[0] >> shift == b[0] >> shift && a[1] >> shift == b[1] >> shift &&
           a[2] >> shift == b[2] >> shift;
  }

 private:
  static constexpr int kCubeBits = 20;
  static constexpr std::uint64_t kMost = (1 << kCubeBits) - 1, kMostCubes = (1 << 21) - 1;

  /// In units of the edge.
  std::array<double, 3> place_of(std::size_t i) const {
    const Vec3 place = (voxels_.position(i) - origin_) * inverse_edge_;
    const auto within = [](double c) { return std::clamp(c, 0.0, 0x1p62); };
    return {within(place.x()), within(place.y()), within(place.z())};
  }

  std::array<std::uint64_t, 3> cell_of(std::size_t i) const {
    const std::array<double, 3> place = place_of(i);
    std::array<std::uint64_t, 3> cell;
    for (std::size_t a = 0; a < 3; ++a) cell[a] = static_cast<std::uint64_t>(place[a]);
    return cell;
  }

  VoxelSpan voxels_;
  Vec3 origin_;
  double inverse_edge_, cells_along_;
};

}  // namespace pcednet::gls
