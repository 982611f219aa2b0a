#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

struct Neighbour {
  std::uint32_t index;  ///< into the positions the tree was made from
  double sq_distance;
};

/// Exact nearest-neighbour and radius queries over a fixed set of points.
///
/// Results depend on the set of positions, not on their numbering: they are sorted by distance,
/// ties by x, y, z of the neighbour; if equally distant points compete for the last place, the
/// choice is the same for any numbering. Queries may run in parallel.
class KdTree {
 public:
  /// Points that are not finite are never found. Keeps its own copy of the positions.
  explicit KdTree(std::span<const Vec3> positions);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  /// The finite points.
  std::size_t size() const;

  /// The `count` points nearest to `query` (including `query` if it is a point of the set), fewer
  /// if the set is smaller. `query` must be finite. Replaces the content of `found`.
  void nearest(const Vec3& query, std::size_t count, std::vector<Neighbour>& found) const;

  /// Their squared distances, ascending, as many as `sq_distances` has room for; returns how many
  /// there are.
  std::size_t nearest(const Vec3& query, std::span<double> sq_distances) const;

  /// Every point closer to `query` than `radius`. Replaces the content of `found`.
  void within(const Vec3& query, double radius, std::vector<Neighbour>& found) const;

  /// The same points without the cost of sorting, in the order of the tree, which is also the same
  /// for any numbering except for coincident points.
  void within_unsorted(const Vec3& query, double radius, std::vector<Neighbour>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pcednet::spatial
