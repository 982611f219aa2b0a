#include "pcednet/tiles/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

constexpr double kCellsAlong = 512;
constexpr std::size_t kMostTiles = 1'000'000;

// The program with its model and read buffers, and bytes per point: for measurements see
// docs/large.md.
constexpr std::uint64_t kFixedBytes = 100'000'000, kBytesPerPoint = 300;
constexpr std::uint64_t kNormalBytes = 150, kNeighbourBytes = 10, kMovedBytes = sizeof(Vec3);

/// Sums of counts over rectangles of cells.
class SummedCounts {
 public:
  explicit SummedCounts(const CellCounts& counts) {
    for (const auto& [cell, count] : counts.cells()) {
      left_ = std::min(left_, cell.first), bottom_ = std::min(bottom_, cell.second);
      right_ = std::max(right_, cell.first + 1), top_ = std::max(top_, cell.second + 1);
    }
    if (counts.cells().empty()) left_ = bottom_ = right_ = top_ = 0;
    sums_.assign((columns() + 1) * (rows() + 1), 0);
    for (const auto& [cell, count] : counts.cells()) {
      sums_[place(cell.first + 1, cell.second + 1)] += count;
    }
    for (std::int64_t x = left_; x <= right_; ++x) {
      for (std::int64_t y = bottom_ + 1; y <= top_; ++y)
        sums_[place(x, y)] += sums_[place(x, y - 1)];
    }
    for (std::int64_t x = left_ + 1; x <= right_; ++x) {
      for (std::int64_t y = bottom_; y <= top_; ++y) sums_[place(x, y)] += sums_[place(x - 1, y)];
    }
  }

  std::int64_t left() const { return left_; }
  std::int64_t right() const { return right_; }
  std::int64_t bottom() const { return bottom_; }
  std::int64_t top() const { return top_; }

  /// Over the cells [x0, x1) x [y0, y1).
  std::uint64_t sum(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) const {
    x0 = std::clamp(x0, left_, right_), x1 = std::clamp(x1, left_, right_);
    y0 = std::clamp(y0, bottom_, top_), y1 = std::clamp(y1, bottom_, top_);
    return sums_[place(x1, y1)] - sums_[place(x0, y1)] - sums_[place(x1, y0)] +
           sums_[place(x0, y0)];
  }

 private:
  std::size_t columns() const { return static_cast<std::size_t>(right_ - left_); }
  std::size_t rows() const { return static_cast<std::size_t>(top_ - bottom_); }
  std::size_t place(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>(x - left_) * (rows() + 1) +
           static_cast<std::size_t>(y - bottom_);
  }

  std::int64_t left_ = INT64_MAX, bottom_ = INT64_MAX, right_ = INT64_MIN, top_ = INT64_MIN;
  std::vector<std::uint64_t> sums_ = {};
};

/// Calls `use` with the points of every core, and with those of the core and its buffer.
template <typename Use>
void for_each_core(const SummedCounts& sums, const Grid& grid, double buffer, const Use& use) {
  const auto around = static_cast<std::int64_t>(std::ceil(buffer / grid.cell));
  for (auto c = grid.core_of_cell(sums.left()); c * grid.across < sums.right(); ++c) {
    for (auto r = grid.core_of_cell(sums.bottom()); r * grid.across < sums.top(); ++r) {
      const std::int64_t x = c * grid.across, y = r * grid.across;
      use(sums.sum(x, y, x + grid.across, y + grid.across),
          sums.sum(x - around, y - around, x + grid.across + around, y + grid.across + around));
    }
  }
}

std::uint64_t most_in(const SummedCounts& sums, const Grid& grid, double buffer) {
  std::uint64_t most = 0;
  for_each_core(sums, grid, buffer, [&](std::uint64_t, std::uint64_t with_buffer) {
    most = std::max(most, with_buffer);
  });
  return most;
}

/// The names in braces of a template, and their values for a tile.
std::vector<std::pair<std::string, std::string>> names_in_braces(std::size_t id, std::size_t tiles,
                                                                 const Tile& tile,
                                                                 const Grid& grid) {
  const auto edge = [&](std::int64_t core) { return fmt::format("{:.12g}", grid.edge(core)); };
  return {{"{ID}", fmt::format("{:0{}}", id, std::to_string(tiles - 1).size())},
          {"{COLUMN}", std::to_string(tile.column)},
          {"{ROW}", std::to_string(tile.row)},
          {"{XLEFT}", edge(tile.column)},
          {"{XRIGHT}", edge(tile.column + 1)},
          {"{YBOTTOM}", edge(tile.row)},
          {"{YTOP}", edge(tile.row + 1)}};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at; (at = text.find(what)) != std::string::npos;) {
    text.replace(at, what.size(), by);
  }
  return text;
}

std::string name_of(std::size_t id, std::size_t tiles, const Tile& tile, const Grid& grid,
                    std::string name) {
  for (const auto& [place, value] : names_in_braces(id, tiles, tile, grid)) {
    name = replaced(std::move(name), place, value);
  }
  return name;
}

/// Throws for a { that begins none of these names.
void check_braces(const std::string& output) {
  std::string known;
  for (const auto& [place, value] : names_in_braces(0, 1, {}, {})) {
    known += (known.empty() ? "" : ", ") + place;
  }
  for (std::size_t at = 0; (at = output.find('{', at)) != std::string::npos; ++at) {
    const std::string place = output.substr(at, output.find('}', at) - at + 1);
    if (place.back() == '}' && (known + ",").find(place + ",") != std::string::npos) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: names of tiles have no {}; there are {}", output, place, known));
  }
}

}  // namespace

void check_template(const std::string& output) {
  const formats::Format* format = formats::find_format(output);
  if (!format || !format->is_tiled()) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: tiles are written as .laz, .las or .ply", output));
  }
  if (fs::path(output).has_parent_path()) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: names of tiles have no folder", output));
  }
  check_braces(output);
}

void CellCounts::add(std::span<const Vec3> positions) {
  std::array<std::int64_t, 2> last = {};
  std::uint64_t* count = nullptr;
  for (const Vec3& position : positions) {
    if (!has_place(position)) {
      ++without_place_;
      continue;
    }
    const auto cell = grid_.cell_of(position);
    if (!count || cell != last) count = &cells_[{cell[0], cell[1]}];
    last = cell;
    ++*count;
  }
}

double cell_length(const BoundingBox& box) {
  if (box.empty()) return 1.0;
  const double side = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y());
  const double least = std::max(side, 1e-3) / kCellsAlong;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10.0 * power;
}

Vec3 shares_of(const BoundingBox& box, const BoundingBox& whole) {
  Vec3 shares = Vec3::Ones();
  for (int axis = 0; axis < 3; ++axis) {
    const double length = whole.max[axis] - whole.min[axis];
    if (length > 0.0 && !box.empty()) shares[axis] = (box.max[axis] - box.min[axis]) / length;
  }
  return shares;
}

std::uint64_t memory_for(std::uint64_t points, const detect::NormalsDecision& normals) {
  std::uint64_t made = normals.made ? kNormalBytes + kNeighbourBytes * normals.neighbours : 0;
  if (normals.rounding.step > 0.0) made += kMovedBytes;
  return kFixedBytes + (kBytesPerPoint + made) * points;
}

std::uint64_t most_points(const CellCounts& counts, const Grid& grid, double buffer) {
  return most_in(SummedCounts(counts), grid, buffer);
}

std::uint64_t points_with_buffers(const CellCounts& counts, const Grid& grid, double buffer) {
  std::uint64_t sum = 0;
  for_each_core(SummedCounts(counts), grid, buffer, [&](std::uint64_t core, std::uint64_t with) {
    if (core > 0) sum += with;
  });
  return sum;
}

Grid choose_grid(const CellCounts& counts, double cell, const TileLimits& limits) {
  const SummedCounts sums(counts);
  const std::int64_t all = std::max(sums.right() - sums.left(), sums.top() - sums.bottom());
  const auto least = static_cast<std::int64_t>(std::ceil(limits.buffer / cell));
  // Cores begin at multiples of their length, so that one core may hold all only if it is longer.
  for (std::int64_t across = 2 * std::max<std::int64_t>(all, 1); across > least; --across) {
    const Grid grid{cell, across};
    const std::uint64_t points = most_in(sums, grid, limits.buffer);
    if (memory_for(points, limits.normals) <= limits.memory) return grid;
  }
  return {cell, std::max<std::int64_t>(least, 1)};
}

std::vector<Tile> lay_out(const CellCounts& counts, const Grid& grid, const fs::path& folder,
                          const std::string& output) {
  check_template(output);
  std::map<std::pair<std::int64_t, std::int64_t>, std::uint64_t> cores;
  for (const auto& [cell, count] : counts.cells()) {
    cores[{grid.core_of_cell(cell.first), grid.core_of_cell(cell.second)}] += count;
  }
  if (cores.empty()) cores[{0, 0}] = 0;
  if (cores.size() > kMostTiles) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} tiles of length {:g}: at most {}; choose longer ones", cores.size(),
                            grid.length(), kMostTiles));
  }
  cores.begin()->second += counts.without_place();
  std::vector<Tile> tiles;
  for (const auto& [core, count] : cores) tiles.push_back({core.first, core.second, count, {}});
  std::set<std::string> names;
  for (std::size_t id = 0; id < tiles.size(); ++id) {
    const std::string name = name_of(id, tiles.size(), tiles[id], grid, output);
    if (!names.insert(name).second) {
      throw Error(
          ErrorKind::kUsage,
          fmt::format("{}: two tiles would be named {}; {{ID}} tells them apart", output, name));
    }
    tiles[id].output = folder / name;
  }
  return tiles;
}

}  // namespace pcednet::tiles
