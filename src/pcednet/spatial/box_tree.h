#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

/// A tree of boxes over items along a space-filling curve. Runs of items are compact, so the tree
/// consists of the boxes of runs, and of runs of runs. It takes four bytes per item.
class BoxTree {
 public:
  static constexpr std::size_t kLeaf = 8;    ///< items per box of the lowest row
  static constexpr std::size_t kFanOut = 8;  ///< boxes per box of the row above

  BoxTree() = default;

  /// `position_at(i)` is the position of item `i` of `count`.
  template <typename PositionAt>
  BoxTree(std::size_t count, PositionAt&& position_at);

  /// Appends the runs (items [kLeaf * run, kLeaf * (run + 1))) whose boxes are closer than
  /// `distance` to the box from `min` to `max`, in order.
  void runs_near(const Vec3& min, const Vec3& max, double distance,
                 std::vector<std::uint32_t>& runs) const;

  /// Fills `sq_distances` with the squared distances from an item to its nearest, the first of
  /// which is itself, ascending. Returns their number, less than the size if there are fewer items.
  template <typename PositionAt>
  std::size_t nearest(std::size_t item, std::span<double> sq_distances,
                      PositionAt&& position_at) const;

 private:
  struct Box {
    Vec3 min = Vec3::Constant(std::numeric_limits<double>::max());
    Vec3 max = Vec3::Constant(std::numeric_limits<double>::lowest());

    void grow(const Box& box);
    double sq_gap(const Box& box) const;
  };
  /// The box of a run, or a little more, from the lower corner of the box of its family.
  struct RunBox {
    std::array<float, 3> min, max;
  };
  static constexpr std::size_t kMostRows = 21;  ///< 8^21 items
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  void make(const std::function<Box(std::size_t)>& box_of_run);
  static RunBox within(const Box& family, const Box& run);
  Box box(std::size_t row, std::size_t i) const;
  std::size_t boxes(std::size_t row) const {
    return row == 0 ? runs_.size() : rows_[row - 1].size();
  }
  std::size_t row_count() const { return 1 + rows_.size(); }

  std::size_t count_ = 0;
  std::vector<RunBox> runs_;            ///< the lowest row
  std::vector<std::vector<Box>> rows_;  ///< those above: families of runs, families of these
};

inline void BoxTree::Box::grow(const Box& box) {
  min = min.cwiseMin(box.min);
  max = max.cwiseMax(box.max);
}

inline double BoxTree::Box::sq_gap(const Box& box) const {
  double sum = 0.0;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double gap = std::max({0.0, min[a] - box.max[a], box.min[a] - max[a]});
    sum += gap * gap;
  }
  return sum;
}

inline BoxTree::Box BoxTree::box(std::size_t row, std::size_t i) const {
  if (row > 0) return rows_[row - 1][i];
  const Vec3& corner = rows_.front()[i / kFanOut].min;
  const RunBox& run = runs_[i];
  return {corner + Eigen::Map<const Eigen::Vector3f>(run.min.data()).cast<double>(),
          corner + Eigen::Map<const Eigen::Vector3f>(run.max.data()).cast<double>()};
}

template <typename PositionAt>
BoxTree::BoxTree(std::size_t count, PositionAt&& position_at) : count_(count) {
  make([&](std::size_t run) {
    Vec3 min = position_at(kLeaf * run), max = min;
    for (std::size_t i = kLeaf * run + 1; i < std::min(count, kLeaf * (run + 1)); ++i) {
      const Vec3 position = position_at(i);
      min = min.cwiseMin(position);
      max = max.cwiseMax(position);
    }
    return Box{min, max};
  });
}

template <typename PositionAt>
std::size_t BoxTree::nearest(std::size_t item, std::span<double> sq_distances,
                             PositionAt&& position_at) const {
  std::fill(sq_distances.begin(), sq_distances.end(), std::numeric_limits<double>::infinity());
  const Vec3 query = position_at(item);
  const Box at = {query, query};
  const auto add_run = [&](std::size_t run) {
    for (std::size_t i = kLeaf * run; i < std::min(count_, kLeaf * (run + 1)); ++i) {
      const Vec3 d = position_at(i) - query;
      const double sq = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
      if (!(sq < sq_distances.back())) continue;
      auto place = sq_distances.end() - 1;
      for (; place != sq_distances.begin() && *(place - 1) > sq; --place) *place = *(place - 1);
      *place = sq;
    }
  };
  struct Branch {
    double sq_gap;
    std::size_t row, box;
  };
  std::array<Branch, kFanOut * kMostRows> stack;  // the nearest of each family on top
  std::size_t depth = 0;
  const auto push_family = [&](std::size_t row, std::size_t family, std::size_t without) {
    const std::size_t first = depth, begin = family * kFanOut;
    for (std::size_t b = begin; b < std::min(begin + kFanOut, boxes(row)); ++b) {
      if (b == without) continue;
      const double sq_gap = box(row, b).sq_gap(at);
      if (sq_gap >= sq_distances.back()) continue;
      std::size_t place = depth++;
      for (; place > first && stack[place - 1].sq_gap < sq_gap; --place) {
        stack[place] = stack[place - 1];
      }
      stack[place] = {sq_gap, row, b};
    }
  };
  std::size_t own = item / kLeaf;
  add_run(own);
  for (std::size_t row = 0; row < row_count(); ++row, own /= kFanOut) {
    push_family(row, own / kFanOut, own);
    while (depth > 0) {
      const Branch branch = stack[--depth];
      if (branch.sq_gap >= sq_distances.back()) continue;
      if (branch.row == 0) add_run(branch.box);
      if (branch.row > 0) push_family(branch.row - 1, branch.box, kNone);
    }
  }
  return std::min(count_, sq_distances.size());
}

}  // namespace pcednet::spatial
