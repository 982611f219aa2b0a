#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pcednet/lines/exact/cylinders.h"
#include "pcednet/lines/exact/strip.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// A line in a profile, unbounded on one side.
struct ProfileRay {
  Eigen::Vector2d from, direction;  ///< unit

  double along(const Eigen::Vector2d& at) const { return direction.dot(at - from); }
  double off(const Eigen::Vector2d& at) const {
    const Eigen::Vector2d offset = at - from;
    return std::abs(direction.x() * offset.y() - direction.y() * offset.x());
  }
  bool is_near(const Eigen::Vector2d& at, double within) const {
    return off(at) < within && along(at) > -within;
  }
};

/// The points around the circle of a cylinder, seen in the half-plane of its axis: planes across
/// the axis, cylinders and cones about it are lines there.
class Profile {
 public:
  struct Point {
    std::uint32_t index;
    double angle;        ///< about the axis, from the middle of the largest gap of the cylinder
    Eigen::Vector2d at;  ///< from the axis, from the plane of the circle; spacings
  };

  Profile(const OrderedPoints& cloud, const ExactCylinder& cylinder, double spacing);

  const std::vector<Point>& points() const { return points_; }
  /// The cylinder, cut by the plane.
  const Fit& circle() const { return circle_; }
  /// Its radius, in spacings.
  double radius() const { return circle_.radius / spacing_; }

  /// The arcs, or the circle, where two surfaces meet that go along these rays from one place: both
  /// have points there and end there.
  std::vector<Piece> arcs(const ProfileRay& a, const ProfileRay& b) const;
  /// The fillets between such surfaces: along the middle of their arcs.
  std::vector<Piece> fillets(const ProfileRay& a, const ProfileRay& b) const;
  /// The angle about the axis, all parts together, in which there are points on the ray.
  double turn_along(const ProfileRay& ray) const;

 private:
  double angle_of(const Vec3& place) const;
  Vec3 out_at(double angle) const;
  std::vector<std::uint32_t> indices_around(const ExactCylinder& cylinder) const;
  Strip strip_along(const ProfileRay& ray) const;
  std::vector<Interval> bridged(const std::vector<Interval>& intervals, const ProfileRay& a,
                                const ProfileRay& b) const;
  /// That the points beside the interval are of an edge.
  double mean_probability(const Interval& interval, const Eigen::Vector2d& at) const;
  Piece piece_along(const Interval& interval, const ProfileRay& a, const ProfileRay& b) const;

  const OrderedPoints& cloud_;
  Fit circle_;
  double spacing_;
  double on_ray_;      ///< how near to one, in spacings
  Vec3 start_, left_;  ///< unit: where angles begin, and a quarter turn on
  std::vector<Point> points_;
};

}  // namespace pcednet::lines
