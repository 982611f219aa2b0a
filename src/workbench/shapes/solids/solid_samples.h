#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "workbench/shapes/solids/solid.h"

namespace pcednet::shapes {

/// A point of a solid's boundary.
struct FacePoint {
  Vec3 position;
  Vec3 normal;  ///< unit, out of the solid
  Face face;
};

/// Points on the boundary, uniform by area, and that area.
struct SolidSamples {
  std::vector<FacePoint> points;
  double area = 0.0;

  /// The spacing of a regular pattern: sqrt(area / points).
  double spacing() const;
};

/// `count` points uniform by area: points of a thin shell about the boundary, projected onto it.
/// Throws Error(kFailure) if the solid has almost no boundary.
SolidSamples sample_solid(const Solid& solid, std::size_t count, std::uint64_t seed);

/// A point on the border of two faces.
struct BorderPoint {
  Vec3 position;
  Face a, b;
  Vec3 normal_a, normal_b;  ///< of either face at the point

  Vec3 normal() const { return (normal_a + normal_b).normalized(); }
  double turn() const;  ///< the angle between the normals, radians; 0 where faces join smoothly
};

/// The positions of face points or border points.
std::vector<Vec3> positions_of(const auto& points) {
  std::vector<Vec3> positions;
  for (const auto& point : points) positions.push_back(point.position);
  return positions;
}

/// Points of the borders between faces, accurate to 1e-9, one per sample near a border.
std::vector<BorderPoint> find_borders(const Solid& solid, const SolidSamples& samples);

/// The same from points near the boundary, which are first projected onto it: a border point
/// between each and the nearest of its 12 neighbours on another face.
std::vector<BorderPoint> borders_among(const Solid& solid, std::span<const Vec3> positions);

}  // namespace pcednet::shapes
