#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace pcednet::shapes {

using Vec2 = Eigen::Vector2d;

/// A closed counter-clockwise outline in the plane, of line segments and arcs.
class Profile {
 public:
  /// A straight side, or an arc of at most half a turn: about `centre`, `radius` > 0, the material
  /// on the side of the centre (`convex`) or on the other.
  struct Side {
    Vec2 a, b;
    double radius = 0.0;
    Vec2 centre = Vec2::Zero();
    bool convex = true;
  };

  Profile() = default;
  explicit Profile(std::vector<Side> sides);

  std::size_t size() const { return sides_.size(); }
  bool is_round(std::size_t i) const { return sides_[i].radius > 0.0; }
  bool is_level(std::size_t i) const { return sides_[i].a.y() == sides_[i].b.y(); }

  /// The signed distance of `p` to the outline, negative inside, and the nearest side.
  double distance(const Vec2& p, std::size_t& nearest) const;

  /// The signed distance to the line or circle that side `i` is part of.
  double distance_to(std::size_t i, const Vec2& p) const;

  /// The outline's box.
  Vec2 low() const;
  Vec2 high() const;

 private:
  /// Sides one after another, and a disc that holds them and their bulges.
  struct Run {
    std::size_t begin, end;
    Vec2 middle;
    double reach;

    double distance_to_disc(const Vec2& p) const { return (p - middle).norm() - reach; }
  };

  double sq_distance_to_nearest_run(const Vec2& p) const;
  bool contains(const Vec2& p) const;

  std::vector<Side> sides_;
  std::vector<Run> runs_;
};

/// A corner of an outline: sharp, rounded or cut off.
struct Corner {
  Vec2 at;
  enum class Shape { kSharp, kFillet, kChamfer } shape = Shape::kSharp;
  double size = 0.0;  ///< radius of the fillet, or length cut off each side by the chamfer
};

using CornerShape = Corner::Shape;

/// The outline through `corners`, counter-clockwise. A fillet or chamfer that does not fit its
/// sides is made smaller.
Profile outline(const std::vector<Corner>& corners);

Profile circle_profile(const Vec2& centre, double radius);

/// A slot: the points within `radius` of the segment from a to b.
Profile slot_profile(const Vec2& a, const Vec2& b, double radius);

}  // namespace pcednet::shapes
