#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

/// The plane through a point and its neighbours.
struct PlaneFit {
  Vec3 normal = Vec3::Zero();  ///< unit length, or zero if there is no plane
  double thickness = 0.0;      ///< smallest eigenvalue over the middle one, from 0 to 1
  double width = 0.0;          ///< middle eigenvalue over the largest, from 0 to 1
};

/// Fits a plane to each of the points numbered `some` and its neighbours, see estimate_normals():
/// `neighbours` holds a row for each of them, all distinct, nearest first.
void fit_planes(std::span<const Vec3> points, std::span<const std::uint32_t> some,
                std::span<const std::uint32_t> neighbours, std::span<PlaneFit> fits);

/// The same for the nearest `count` neighbours in a graph.
std::vector<PlaneFit> fit_planes(const NeighbourGraph& graph, std::span<const std::uint32_t> some,
                                 std::size_t count);

}  // namespace pcednet::normals
