#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// How many points there are in each cell of a grid; points that are not finite apart.
class CellCounts {
 public:
  explicit CellCounts(double cell) : grid_{cell, 1} {}

  void add(std::span<const Vec3> positions);
  void add_not_finite(std::uint64_t points) { not_finite_ += points; }

  std::uint64_t not_finite() const { return not_finite_; }
  const std::map<std::pair<std::int64_t, std::int64_t>, std::uint64_t>& cells() const {
    return cells_;
  }

 private:
  Grid grid_;
  std::uint64_t not_finite_ = 0;
  std::map<std::pair<std::int64_t, std::int64_t>, std::uint64_t> cells_ = {};
};

/// The length of the cells to count in, so that there are about 512 along the longer side: a power
/// of ten, or two or five of them.
double cell_length(const BoundingBox& box);

/// The share of each side of `whole` that `box` takes; 1 of a side without length, or of an empty
/// box.
Vec3 shares_of(const BoundingBox& box, const BoundingBox& whole);

/// The most points in a core and its buffer, for cores of so many cells.
std::uint64_t most_points(const CellCounts& counts, const Grid& grid, double buffer);

/// Bytes that a tile of so many points, buffer included, takes while it is run: normals that are
/// made take most.
std::uint64_t memory_for(std::uint64_t points, const detect::NormalsDecision& normals);

struct TileLimits {
  double buffer = 0.0;
  std::uint64_t memory = 0;
  detect::NormalsDecision normals = {};
};

/// The largest cores of which none takes more than the memory with its buffer; at least as long as
/// the buffer is wide.
Grid choose_grid(const CellCounts& counts, double cell, const TileLimits& limits);

/// The tiles with points, column by column, named by `output`: a template with {ID}, {COLUMN},
/// {ROW}, {XLEFT}, {XRIGHT}, {YBOTTOM} and {YTOP}. Points that are not finite are in the first.
/// Throws Error(kUsage) for a template that gives two tiles one name, or no point file.
std::vector<Tile> lay_out(const CellCounts& counts, const Grid& grid,
                          const std::filesystem::path& folder, const std::string& output);

}  // namespace pcednet::tiles
