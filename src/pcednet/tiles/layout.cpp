#include "pcednet/tiles/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

constexpr double kCellsAlong = 512;
// Shorter cells are taken until so many columns or rows hold at least one point in kLeastShare, or
// there would be too many.
constexpr std::ptrdiff_t kLeastAlong = 64;
constexpr std::size_t kLeastShare = 2048, kMostCells = 1 << 20;
constexpr std::size_t kEnough = 1 << 16;  ///< points are counted for that
constexpr double kLeastCell = 1e-9;       ///< of the extent and the coordinates
constexpr std::int64_t kSteps = 1024;

constexpr std::size_t kMostTiles = 1'000'000;

// The program with its model and read buffers, and bytes per point: for measurements see
// docs/large.md.
constexpr std::uint64_t kFixedBytes = 100'000'000, kBytesPerPoint = 300;
constexpr std::uint64_t kNormalBytes = 90, kNeighbourBytes = 6, kMovedBytes = sizeof(Vec3);
constexpr std::uint64_t kAveragedBytes = 60;  ///< there are fewer normals

/// Sums of counts over rectangles of cells. Holds only columns and rows that have points: there may
/// be far gaps between them.
class SummedCounts {
 public:
  explicit SummedCounts(const CellCounts& counts) {
    std::set<std::int64_t> columns, rows;
    for (const auto& [cell, count] : counts.cells()) {
      columns.insert(columns.end(), cell.first);
      rows.insert(cell.second);
    }
    columns_.assign(columns.begin(), columns.end());
    rows_.assign(rows.begin(), rows.end());
    sums_.assign((columns_.size() + 1) * (rows_.size() + 1), 0);
    for (const auto& [cell, count] : counts.cells()) {
      sums_[place(cell.first + 1, cell.second + 1)] += count;
    }
    const std::size_t row = rows_.size() + 1;  // of the sums
    for (std::size_t i = row; i < sums_.size(); ++i) sums_[i] += i % row ? sums_[i - 1] : 0;
    for (std::size_t i = row; i < sums_.size(); ++i) sums_[i] += sums_[i - row];
  }

  /// Ascending.
  std::span<const std::int64_t> columns() const { return columns_; }
  std::span<const std::int64_t> rows() const { return rows_; }

  /// Over the cells [x0, x1) x [y0, y1).
  std::uint64_t sum(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) const {
    return sums_[place(x1, y1)] - sums_[place(x0, y1)] - sums_[place(x1, y0)] +
           sums_[place(x0, y0)];
  }

 private:
  static std::size_t before(std::span<const std::int64_t> lines, std::int64_t index) {
    return static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), index) -
                                    lines.begin());
  }
  std::size_t place(std::int64_t x, std::int64_t y) const {
    return before(columns_, x) * (rows_.size() + 1) + before(rows_, y);
  }

  std::vector<std::int64_t> columns_, rows_;
  std::vector<std::uint64_t> sums_;
};

/// The first cells of the cores that hold some of these columns, or rows.
std::vector<std::int64_t> core_begins(std::span<const std::int64_t> lines, const Grid& grid) {
  std::vector<std::int64_t> begins;
  for (const std::int64_t line : lines) {
    const std::int64_t begin = grid.core_of_cell(line) * grid.across;
    if (begins.empty() || begins.back() != begin) begins.push_back(begin);
  }
  return begins;
}

/// Calls `use` with the points of every core, and with those of the core and its buffer.
template <typename Use>
void for_each_core(const SummedCounts& sums, const Grid& grid, double buffer, const Use& use) {
  const auto around = static_cast<std::int64_t>(std::ceil(buffer / grid.cell));
  const std::vector<std::int64_t> bottoms = core_begins(sums.rows(), grid);
  for (const std::int64_t x : core_begins(sums.columns(), grid)) {
    for (const std::int64_t y : bottoms) {
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

/// How many of the sampled points the columns, or rows, of its cells hold.
std::vector<std::size_t> counts_along(std::span<const Vec3> sample, int axis, double cell) {
  std::vector<double> lines;
  const std::size_t step = sample.size() / kEnough + 1;
  for (std::size_t i = 0; i < sample.size(); i += step) {
    lines.push_back(std::floor(sample[i][axis] / cell));
  }
  std::sort(lines.begin(), lines.end());
  std::vector<std::size_t> counts;
  for (auto line = lines.begin(); line != lines.end();) {
    const auto next = std::upper_bound(line, lines.end(), *line);
    counts.push_back(static_cast<std::size_t>(next - line));
    line = next;
  }
  return counts;
}

/// Whether cells of this length are so many that the tiles can have the length that the memory
/// allows: far points make the box much larger than what most points take.
bool are_fine(std::span<const Vec3> sample, double cell) {
  const auto columns = counts_along(sample, 0, cell), rows = counts_along(sample, 1, cell);
  const auto are_many = [&](const std::vector<std::size_t>& counts) {
    return std::count_if(counts.begin(), counts.end(), [&](std::size_t count) {
             return count * kLeastShare >= std::min(sample.size(), kEnough);
           }) >= kLeastAlong;
  };
  return are_many(columns) || are_many(rows) || columns.size() * rows.size() > kMostCells;
}

/// The shortest of 1, 2 or 5 times a power of ten that is not below `least`.
double preferred_from(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10.0 * power;
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

double cell_length(const BoundingBox& box, std::span<const Vec3> sample) {
  if (box.empty()) return 1.0;
  const double side = std::max({box.max.x() - box.min.x(), box.max.y() - box.min.y(), 1e-3});
  double cell = preferred_from(side / kCellsAlong);
  while (cell > kLeastCell * std::max(side, box.farthest()) && !are_fine(sample, cell)) {
    cell = preferred_from(0.3 * cell);  // of 10, 5 and 2: 5, 2 and 1
  }
  return cell;
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
  if (normals.averaging.deviation > 0.0) made = kAveragedBytes;
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
  const auto length = [](std::span<const std::int64_t> lines) {
    return lines.empty() ? 1 : lines.back() + 1 - lines.front();
  };
  const std::int64_t all = std::max(length(sums.columns()), length(sums.rows()));
  const auto least = static_cast<std::int64_t>(std::ceil(limits.buffer / cell));
  // Cores begin at multiples of their length, so that one core may hold all only if it is longer.
  for (std::int64_t across = 2 * all; across > least;
       across -= std::max<std::int64_t>(across / kSteps, 1)) {
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
