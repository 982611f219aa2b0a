#include "pcednet/spatial/detail_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "pcednet/core/parallel.h"

namespace pcednet::spatial {
namespace {

constexpr int kKeyBits = 21, kGridBits = 7, kLeastGridBits = 5;
constexpr std::size_t kMostTogether = std::size_t{1} << 20;
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// Every third bit, the lowest first: undoes spread_bits.
std::uint32_t every_third_bit(std::uint64_t v) {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10c30c30c30c30c3;
  v = (v | v >> 4) & 0x100f00f00f00f00f;
  v = (v | v >> 8) & 0x1f0000ff0000ff;
  v = (v | v >> 16) & 0x1f00000000ffff;
  return static_cast<std::uint32_t>((v | v >> 32) & 0x1fffff);
}

std::array<std::uint32_t, 3> cell_of(std::uint64_t code) {
  return {every_third_bit(code >> 2), every_third_bit(code >> 1), every_third_bit(code)};
}

bool comes_before(const TreePoint& a, const TreePoint& b) {
  return std::tie(a.key, a.tie, a.index) < std::tie(b.key, b.tie, b.index);
}

/// In place: first into buckets by the upper bits of the keys, then each bucket by itself.
void sort_points(std::vector<TreePoint>& points) {
  constexpr int kBucketBits = 12;
  constexpr std::size_t kBuckets = std::size_t{1} << kBucketBits;
  const auto bucket_of = [](const TreePoint& p) {
    return static_cast<std::size_t>(p.key >> (3 * kKeyBits - kBucketBits));
  };
  std::vector<std::size_t> end(kBuckets + 1);
  for (const TreePoint& p : points) ++end[bucket_of(p) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  const std::vector<std::size_t> begin = end;
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t b = 0; b < kBuckets; ++b) {
    while (next[b] < begin[b + 1]) {
      const std::size_t home = bucket_of(points[next[b]]);
      if (home == b) {
        ++next[b];
      } else {
        std::swap(points[next[b]], points[next[home]++]);
      }
    }
  }
  const auto at = [&](std::size_t i) { return points.begin() + static_cast<std::ptrdiff_t>(i); };
  parallel_blocks(kBuckets, 1, [&](std::size_t b, std::size_t) {
    std::sort(at(begin[b]), at(begin[b + 1]), comes_before);
  });
}

/// A cell while the tree grows.
struct Cell {
  int depth = 0;
  std::size_t begin = 0, end = 0;  ///< of the sorted points in it
  std::size_t left = 0;            ///< those that no ancestor kept
  std::size_t kept = 0;
  std::size_t first_child = 0, children = 0;
};

/// The square of a point's distance to the centre of its voxel, in quarters of a cell of the keys.
std::uint64_t sq_distance_to_centre(std::uint64_t key, int voxel_bits) {
  const std::uint64_t mask = (std::uint64_t{1} << 3 * voxel_bits) - 1;
  std::uint64_t sum = 0;
  for (const std::uint32_t c : cell_of(key & mask)) {
    const std::int64_t off = 2 * std::int64_t{c} + 1 - (std::int64_t{1} << voxel_bits);
    sum += static_cast<std::uint64_t>(off * off);
  }
  return sum;
}

/// Decides, from the root down, which cell keeps a point. The ties of the points, unused once these
/// are sorted, hold the number of that cell.
class Builder {
 public:
  Builder(std::vector<TreePoint>& points, const DetailTreeOptions& options)
      : points_(points), options_(options) {
    for (TreePoint& p : points_) p.tie = kNobody;
    cells_.push_back({.depth = 0, .begin = 0, .end = points.size(), .left = points.size()});
    for (std::size_t level = 0; level < cells_.size();) {
      const std::size_t next = cells_.size();
      std::vector<std::vector<Cell>> children(next - level);
      parallel_blocks(next - level, 1, [&](std::size_t c, std::size_t) {
        keep(level + c);
        children[c] = children_of(cells_[level + c]);
      });
      for (std::size_t c = 0; c < children.size(); ++c) {
        cells_[level + c].first_child = cells_.size();
        cells_[level + c].children = children[c].size();
        cells_.insert(cells_.end(), children[c].begin(), children[c].end());
      }
      level = next;
    }
  }

  /// Hands the points of small childless cells to their parents, the smallest first, and returns
  /// the cell that each cell's points have gone to.
  std::vector<std::uint32_t> merge() {
    std::vector<std::uint32_t> heir(cells_.size());
    std::iota(heir.begin(), heir.end(), 0U);
    for (std::size_t p = cells_.size(); p-- > 0;) {
      Cell& parent = cells_[p];
      std::vector<std::pair<std::size_t, std::size_t>> small;
      for (std::size_t c = parent.first_child; c < parent.first_child + parent.children; ++c) {
        const bool childless = cells_[c].left == cells_[c].kept;
        if (childless && cells_[c].kept < options_.least) small.emplace_back(cells_[c].kept, c);
      }
      std::sort(small.begin(), small.end());
      for (const auto& [count, c] : small) {
        if (parent.kept + count > options_.most) break;
        parent.kept += count;
        heir[c] = static_cast<std::uint32_t>(p);
      }
    }
    for (std::size_t c = 0; c < heir.size(); ++c) heir[c] = heir[heir[c]];
    return heir;
  }

  const std::vector<Cell>& cells() const { return cells_; }

 private:
  std::span<TreePoint> points_of(const Cell& cell) {
    return std::span(points_).subspan(cell.begin, cell.end - cell.begin);
  }

  void keep(std::size_t number) {
    Cell& cell = cells_[number];
    const auto owner = static_cast<std::uint32_t>(number);
    if (cell.left <= options_.most || cell.depth == kKeyBits) {
      keep_first(cell, owner, cell.left);
    } else if (cell.depth + kLeastGridBits > kKeyBits) {
      keep_first(cell, owner, std::max(options_.most, kMostTogether));
    } else {
      int grid_bits = std::min(kGridBits, kKeyBits - cell.depth);
      while (grid_bits > kLeastGridBits && voxels(cell, grid_bits) > options_.most) --grid_bits;
      thin(cell, owner, grid_bits);
    }
  }

  void keep_first(Cell& cell, std::uint32_t owner, std::size_t count) {
    for (TreePoint& p : points_of(cell)) {
      if (cell.kept == count) break;
      if (p.tie != kNobody) continue;
      p.tie = owner;
      ++cell.kept;
    }
  }

  /// Voxels in which a point is left.
  std::size_t voxels(const Cell& cell, int grid_bits) {
    const int shift = 3 * (kKeyBits - cell.depth - grid_bits);
    std::size_t count = 0;
    std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
    for (const TreePoint& p : points_of(cell)) {
      if (p.tie != kNobody || p.key >> shift == last) continue;
      last = p.key >> shift;
      ++count;
    }
    return count;
  }

  void thin(Cell& cell, std::uint32_t owner, int grid_bits) {
    const int voxel_bits = kKeyBits - cell.depth - grid_bits;
    TreePoint* best = nullptr;
    std::uint64_t least = 0;
    for (TreePoint& p : points_of(cell)) {
      if (p.tie != kNobody) continue;
      const std::uint64_t distance = sq_distance_to_centre(p.key, voxel_bits);
      const bool same = best && best->key >> 3 * voxel_bits == p.key >> 3 * voxel_bits;
      if (same && distance >= least) continue;
      if (best && !same) best->tie = owner;
      cell.kept += same ? 0 : 1;
      best = &p;
      least = distance;
    }
    if (best) best->tie = owner;
  }

  std::vector<Cell> children_of(const Cell& cell) {
    std::vector<Cell> children;
    if (cell.kept == cell.left) return children;
    const int shift = 3 * (kKeyBits - cell.depth - 1);
    for (std::size_t begin = cell.begin, end = begin; begin < cell.end; begin = end) {
      const std::uint64_t code = points_[begin].key >> shift;
      Cell child{.depth = cell.depth + 1, .begin = begin};
      for (; end < cell.end && points_[end].key >> shift == code; ++end) {
        child.left += points_[end].tie == kNobody ? 1 : 0;
      }
      child.end = end;
      if (child.left > 0) children.push_back(child);
    }
    return children;
  }

  std::vector<TreePoint>& points_;
  const DetailTreeOptions& options_;
  std::vector<Cell> cells_ = {};
};

}  // namespace

DetailTree make_detail_tree(std::vector<TreePoint> points, const DetailTreeOptions& options) {
  sort_points(points);
  Builder builder(points, options);
  const std::vector<std::uint32_t> heir = builder.merge();
  DetailTree tree;
  std::vector<std::size_t> next(heir.size());
  std::size_t before = 0;
  for (std::size_t c = 0; c < heir.size(); ++c) {
    if (heir[c] != c) continue;
    const Cell& cell = builder.cells()[c];
    const std::uint64_t key = points.empty() ? 0 : points[cell.begin].key;
    tree.nodes.push_back({cell.depth, cell_of(key >> 3 * (kKeyBits - cell.depth)), cell.kept});
    next[c] = before;
    before += cell.kept;
  }
  tree.places.resize(points.size());
  for (const TreePoint& p : points) {
    tree.places[p.index] = static_cast<std::uint32_t>(next[heir[p.tie]]++);
  }
  return tree;
}

}  // namespace pcednet::spatial
