#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/vec3.h"

namespace pcednet::render {

/// A point drawn as a small disc.
struct Surfel {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  ///< unit length, of either sign
  float radius;            ///< closes the surface between the point and its neighbours; may be 0
  Rgb colour;
  bool edge;  ///< drawn over its surroundings
};

/// The box that was moved and scaled onto [-1, 1]^3.
struct UnitBox {
  Vec3 centre = Vec3::Zero();
  double half = 1.0;  ///< of its longest side

  Eigen::Vector3f to_unit(const Vec3& position) const {
    return ((position - centre) / half).cast<float>();
  }
};

/// The finite points of `cloud` as discs, without far outliers and strays, moved and scaled to fit
/// [-1, 1]^3, in an order that depends on the positions alone.
///
/// The radius follows the local density. If the density is even except at a few points, these are
/// strays: noise that would hide the rest. Points without a normal get one fitted to their
/// neighbours. `classes` as in write_preview(). If there are more than `max_count` points, every
/// n-th is taken. `box`, if given, becomes the box of the result in the cloud. `classes` index
/// `table`.
std::vector<Surfel> make_surfels(const PointCloud& cloud, std::span<const std::uint8_t> classes,
                                 std::size_t max_count, UnitBox* box = nullptr,
                                 const ClassTable& table = edge_classes());

/// Some points close to a point, nearest first, without its exact duplicates.
struct NearPoints {
  static constexpr std::size_t kMost = 8;

  std::array<std::uint32_t, kMost> index;
  std::array<float, kMost> distance;
  std::uint32_t count = 0;
};

/// Approximate nearest neighbours of each point, from the neighbours along three space-filling
/// curves. Much faster than an exact search; it misses some neighbours, which suffices for drawing.
/// Positions must be finite.
std::vector<NearPoints> near_points(std::span<const Vec3> positions);

}  // namespace pcednet::render
