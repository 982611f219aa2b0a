#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::render {

/// A point drawn as a small disc.
struct Surfel {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  ///< unit length, of either sign
  float radius;            ///< closes the surface between the point and its neighbours; may be 0
  Rgb colour;
  bool edge;  ///< drawn over its surroundings
};

/// The finite points of `cloud` as discs, without far outliers and strays, moved and scaled so that
/// they just lie in [-1, 1]^3, in an order that depends on the positions alone.
///
/// The radius follows the local density. Where that is even but for few points, these are strays:
/// noise that would hide the rest. Normals of the cloud are taken where it has them, fitted to the
/// neighbours elsewhere. `classes` as in write_preview(). Of more than `max_count` points every
/// n-th is taken.
std::vector<Surfel> make_surfels(const PointCloud& cloud, std::span<const std::uint8_t> classes,
                                 std::size_t max_count);

}  // namespace pcednet::render
