#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pcednet/spatial/kd_tree.h"
#include "pcednet/spatial/run_tree.h"

namespace pcednet::spatial {

/// Finds the nearest neighbours of the points of one run after the other.
///
/// The points of a run share their candidates: all points within a radius of the run's box. The
/// radius is predicted from the previous run and widened for points with farther neighbours. If
/// that yields too many candidates (an outlier in the run, or much sparser previous runs), the
/// point searches the tree by itself.
class RunSearch {
 public:
  /// `count` is above 0 and below the number of points.
  RunSearch(const RunTree& tree, std::size_t count);

  /// Writes a row of `count` neighbours, as NeighbourSearch promises, for each of `points`, which
  /// belong to `run`.
  void find(std::size_t run, std::span<const std::uint32_t> points, Neighbour* found);

 private:
  struct Query {
    std::uint32_t point;
    Neighbour* found;
  };
  struct Branch {
    double sq_gap;
    std::size_t row, box;
  };

  double guess(std::size_t run) const;
  bool gather(std::size_t run);
  bool select(const Query& query);
  void put_in_order(const Query& query, std::size_t picked);
  void descend(const Query& query);
  void push_branches(std::size_t row, std::size_t node, const double at[3], double bound);
  double sq_distance(std::uint32_t p, std::uint32_t q) const;

  const RunTree& tree_;
  std::size_t count_;
  double sq_radius_ = 0.0;  ///< of the candidates around the box of the run
  double sq_needed_ = 0.0;  ///< the largest distance to a last neighbour
  float sq_guess_ = 0.0f;   ///< predicted from the previous point, in the local frame
  std::unique_ptr<Candidates> near_;
  std::vector<Query> open_;
  std::vector<std::uint32_t> picked_;
  std::vector<double> sq_distances_;
  std::vector<std::int64_t> ranks_;
  std::vector<Neighbour> many_, sorted_;
  std::vector<std::uint32_t> ends_;
  std::vector<Branch> branches_;
};

}  // namespace pcednet::spatial
