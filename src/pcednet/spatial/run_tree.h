#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/unset_array.h"
#include "pcednet/core/vec3.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/spatial/search_kernels.h"

namespace pcednet::spatial {

/// Distinct points in compact runs along a space-filling curve, with the boxes of the runs, of
/// groups of 8 runs, of groups of 64 runs and so on.
struct RunTree {
  static constexpr std::size_t kFanOut = 8;               ///< boxes per node
  static constexpr std::size_t kRun = Candidates::kStep;  ///< points per run at most
  static constexpr std::size_t kMostRows = 12;            ///< for 2^32 runs

  RunTree() = default;
  /// `points` must be finite; in curve_order() the runs are compact.
  explicit RunTree(std::span<const Vec3> points);

  /// Calls visit(run) for each run whose box is within the distance, which is finite, of the box
  /// `min` to `max`, in order, until it returns false; returns whether it never did.
  template <typename Visit>
  bool visit_runs(const double min[3], const double max[3], double sq_distance,
                  const Visit& visit) const;

  /// Every point closer to `at` than `radius`, in order. Replaces the content of `found`.
  void within(const Vec3& at, double radius, std::vector<Neighbour>& found) const;

  std::size_t size() const { return first.empty() ? 0 : first.back(); }
  std::array<const double*, 3> axes() const { return {x.data(), y.data(), z.data()}; }

  UnsetArray<double> x, y, z;        ///< padded with kRun zeros, so that whole runs can be read
  std::vector<std::uint32_t> first;  ///< first point of each run, and size()
  std::vector<std::vector<EightBoxes>> rows;  ///< from the runs up to a single node
};

template <typename Visit>
bool RunTree::visit_runs(const double min[3], const double max[3], double sq_distance,
                         const Visit& visit) const {
  struct Step {
    std::uint32_t row, child;
  };
  Step stack[kFanOut * kMostRows];
  std::size_t depth = 0;
  const auto push_near = [&](std::size_t row, std::size_t node) {
    double gaps[kFanOut];
    sq_gaps(rows[row][node], min, max, gaps);
    // Backwards, so that boxes come off the stack in their order.
    for (std::size_t b = kFanOut; b-- > 0;) {
      stack[depth] = {static_cast<std::uint32_t>(row),
                      static_cast<std::uint32_t>(node * kFanOut + b)};
      depth += gaps[b] <= sq_distance;
    }
  };
  if (!rows.empty()) push_near(rows.size() - 1, 0);
  while (depth > 0) {
    const Step step = stack[--depth];
    if (step.row > 0) {
      push_near(step.row - 1, step.child);
    } else if (!visit(std::size_t{step.child})) {
      return false;
    }
  }
  return true;
}

}  // namespace pcednet::spatial
