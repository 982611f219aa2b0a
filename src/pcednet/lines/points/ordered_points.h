#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/half_space.h"
#include "pcednet/core/progress.h"
#include "pcednet/lines/points/edge_points.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::lines {

/// The finite points along the space-filling curve, so that nothing depends on their numbering.
class OrderedPoints {
 public:
  /// Positions are seen from `origin`.
  explicit OrderedPoints(const EdgePoints& points, const Vec3& origin = Vec3::Zero());

  std::size_t size() const { return positions_.size(); }
  const Vec3& position(std::size_t i) const { return positions_[i]; }
  /// One of a normal and its opposite, the same of both: nothing may depend on signs.
  Vec3 normal(std::size_t i) const { return upward(normals_[i]); }
  /// Whether the surfaces at two points face away from each other, as the two sides of a thin wall
  /// do. The faces of a cube do not, whatever rounding makes of their right angle.
  bool face_away(std::size_t i, std::size_t j) const {
    constexpr double kAway = -0.05;  // a cosine
    return normals_[i].dot(normals_[j]) < kAway;
  }
  /// The same, but not as opposed as the two sides of a thin wall are.
  bool face_acutely(std::size_t i, std::size_t j) const {
    constexpr double kOpposed = -0.97;  // 14 degrees
    return face_away(i, j) && normals_[i].dot(normals_[j]) > kOpposed;
  }
  EdgeClass edge_class(std::size_t i) const {
    return static_cast<EdgeClass>(points_.classes[order_[i]]);
  }
  bool is_edge(std::size_t i) const {
    return edge_class(i) == kSharpEdge || edge_class(i) == kSmoothEdge;
  }
  /// Whether points around it are missing.
  bool is_partial(std::size_t i) const {
    return !points_.partial.empty() && points_.partial[order_[i]] != 0;
  }
  /// Where the scanner stood that saw a point; NaN if that is unknown.
  Vec3 scanner(std::size_t i) const {
    return points_.scanners.empty() ? Vec3(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()))
                                    : Vec3(points_.scanners[order_[i]] - origin_);
  }
  bool has_scanners() const { return !points_.scanners.empty(); }
  bool has_probabilities() const { return !points_.p_sharp.empty(); }
  /// The probability of an edge; from the class alone if there are no probabilities.
  float probability(std::size_t i) const;

  /// Every point closer to `at` than `radius`, in order.
  void within(const Vec3& at, double radius, std::vector<spatial::Neighbour>& found) const {
    search_.within(at, radius, found);
  }

  /// The points closer to any of these places than `radius`, each once, in curve order.
  std::vector<std::uint32_t> near_any(std::span<const Vec3> places, double radius) const;

  /// The available(count) nearest others of each of `points` (ascending), row after row.
  void nearest_others(std::span<const std::uint32_t> points, std::size_t count,
                      std::vector<spatial::Neighbour>& found) const;
  std::size_t available(std::size_t count) const { return search_.available(count); }

  /// Calls visit(k, row of nearest_others()) for each of `points`, on all threads.
  void for_each_neighbourhood(std::span<const std::uint32_t> points, std::size_t count,
                              Stage& stage, const spatial::NeighbourSearch::Visit& visit) const {
    search_.for_each_neighbourhood(points, count, visit, &stage);
  }

 private:
  EdgePoints points_;
  Vec3 origin_;
  std::vector<std::uint32_t> order_;
  std::vector<Vec3> positions_, normals_;
  spatial::NeighbourSearch search_;
};

/// The side of the square that holds one point, from the nearest others of a point; 0 if there are
/// none.
double spacing_of(std::span<const spatial::Neighbour> others);

}  // namespace pcednet::lines
