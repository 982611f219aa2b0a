#pragma once

#include <cstdint>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/half_space.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/spatial/places.h"

namespace pcednet::detect {

/// The finite positions along the curve, each once, in an order independent of their numbering.
struct DistinctPoints : spatial::Places {
  const PreparedCloud& cloud;

  explicit DistinctPoints(const PreparedCloud& prepared)
      : spatial::Places(spatial::places_of(prepared.positions, prepared.curve)), cloud(prepared) {}

  /// The normal of a point; zero if none is usable. If copies differ, the first by its components,
  /// in whatever sense.
  Vec3 normal(std::size_t point) const {
    Vec3 found = Vec3::Zero();
    for (const std::uint32_t copy : points(point)) {
      const Vec3& normal = cloud.normals[copy];
      if (is_usable(normal) && (found.isZero(0.0) || is_before(upward(normal), upward(found)))) {
        found = normal;
      }
    }
    return found;
  }
};

}  // namespace pcednet::detect
