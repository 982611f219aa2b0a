#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// The number of points in each cell of a grid; points without a place are counted separately.
class CellCounts {
 public:
  explicit CellCounts(double cell) : grid_{cell, 1} {}

  void add(std::span<const Vec3> positions);
  void add_without_place(std::uint64_t points) { without_place_ += points; }

  std::uint64_t without_place() const { return without_place_; }
  const std::map<std::pair<std::int64_t, std::int64_t>, std::uint64_t>& cells() const {
    return cells_;
  }

 private:
  Grid grid_;
  std::uint64_t without_place_ = 0;
  std::map<std::pair<std::int64_t, std::int64_t>, std::uint64_t> cells_ = {};
};

/// The length of the counting cells, 1, 2 or 5 times a power of ten: there are about 512 along the
/// longer side of the box, or more if most points, of which there is a sample, take a small part of
/// it.
double cell_length(const BoundingBox& box, std::span<const Vec3> sample);

/// The share of each side of `whole` that `box` takes; 1 for a side without length, or an empty
/// box.
Vec3 shares_of(const BoundingBox& box, const BoundingBox& whole);

/// The most points in a core of `grid` and its buffer.
std::uint64_t most_points(const CellCounts& counts, const Grid& grid, double buffer);

/// The points in all cores of `grid` that have some, each counted with its buffer.
std::uint64_t points_with_buffers(const CellCounts& counts, const Grid& grid, double buffer);

/// The memory in bytes for running a tile of `points` points, buffer included: estimating normals
/// takes most.
std::uint64_t memory_for(std::uint64_t points, const detect::NormalsDecision& normals);

struct TileLimits {
  double buffer = 0.0;
  std::uint64_t memory = 0;
  detect::NormalsDecision normals = {};
};

/// The largest cores that fit into the memory with their buffers; at least as long as the buffer is
/// wide.
Grid choose_grid(const CellCounts& counts, double cell, const TileLimits& limits);

/// Throws Error(kUsage) unless `output` is a template for names of tiles: the name of a point file
/// with {ID}, {COLUMN}, {ROW}, {XLEFT}, {XRIGHT}, {YBOTTOM} and {YTOP}.
void check_template(const std::string& output);

/// The tiles that have points, column by column, named by the template `output`. Points without a
/// place are in the first. Throws as check_template() does, and Error(kUsage) for a template that
/// gives two tiles one name.
std::vector<Tile> lay_out(const CellCounts& counts, const Grid& grid,
                          const std::filesystem::path& folder, const std::string& output);

}  // namespace pcednet::tiles
