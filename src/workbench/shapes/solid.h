#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/vec3.h"
#include "workbench/shapes/profile.h"

namespace pcednet::shapes {

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
    Vec3 centre;   ///< of a ball that holds the volume
    double reach;  ///< its radius
    bool filled;
  };

  void put(Volume volume, bool filled);

  std::vector<Feature> volumes_;
  BoundingBox box_;
};

}  // namespace pcednet::shapes
