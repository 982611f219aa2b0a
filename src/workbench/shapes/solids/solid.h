#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/vec3.h"

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

/// A volume: a profile extruded along z, or revolved about it.
struct Volume {
  enum class Kind {
    kPrism,      ///< profile in (x, y), |z| <= half_height
    kRevolution  ///< profile in (distance from the z axis, z)
  } kind = Kind::kPrism;
  Profile profile = {};
  double half_height = 1.0;
  /// Rims of a prism, where the sides meet the caps: sharp, rounded or cut off, by `rim_size`.
  Corner::Shape rim = Corner::Shape::kSharp;
  double rim_size = 0.0;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< from the volume to the solid
};

/// A smooth piece of a solid's boundary: a plane, or part of a cylinder, cone, sphere or torus.
struct Face {
  std::uint32_t volume = 0;
  std::uint16_t side = 0;  ///< of the profile
  enum class Part : std::uint8_t { kSide, kTop, kBottom, kTopRim, kBottomRim } part = Part::kSide;

  friend bool operator==(const Face&, const Face&) = default;
};

/// Constructive solid geometry: volumes added and cut one after another, as an implicit function.
class Solid {
 public:
  void add(Volume volume) { put(std::move(volume), true); }
  void cut(Volume volume) { put(std::move(volume), false); }

  struct Value {
    double distance;  ///< negative inside; exact near the boundary except at concave edges
    Face face;        ///< the face that determines it
  };
  Value value(const Vec3& p) const;

  /// The distance to the unbounded surface that contains the face, and its gradient of length 1,
  /// out of the solid.
  double distance_to(const Face& face, const Vec3& p) const;
  Vec3 normal_of(const Face& face, const Vec3& p) const;

  /// True if the face is not plane.
  bool is_curved(const Face& face) const;

  /// A box that holds the solid.
  const BoundingBox& box() const { return box_; }

 private:
  struct Feature {
    Volume volume;
    Eigen::Isometry3d to_local;
    Vec3 centre;             ///< of a ball that holds the volume
    double reach;            ///< its radius
    Vec2 middle, half_size;  ///< of the profile's box
    bool filled;

    /// The volume's value is at least this, but for rounding: its signed distance to the caps and
    /// to the profile's box.
    double least_distance(const Vec3& local) const;
  };

  void put(Volume volume, bool filled);

  std::vector<Feature> volumes_;
  BoundingBox box_;
};

}  // namespace pcednet::shapes
