#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::annotate {

inline constexpr std::size_t kMostNodePoints = 65536;

/// A cube of the octree and its share of the points. To draw it, draw its ancestors too: a node has
/// the points that its ancestors leave.
struct Node {
  Vec3 centre = Vec3::Zero();
  double half = 0;
  std::size_t first = 0, points = 0;         ///< its points in Layout::order
  std::vector<std::uint32_t> children = {};  ///< numbers of nodes
  double spacing =
      0;  ///< approximate spacing of drawn points once this node and its ancestors are drawn
};

/// The finite points of a cloud in an octree; node 0 is the root. Points far from all others
/// (box_of_most()) have cubes of their own, children of the root: they would coarsen every place.
struct Layout {
  std::vector<Node> nodes = {};
  std::vector<std::uint32_t> order = {};    ///< the points, node after node, each exactly once
  std::vector<std::uint32_t> node_of = {};  ///< per point of the cloud; kNoNode if not finite
};

inline constexpr std::uint32_t kNoNode = 0xffffffff;

/// Makes the octree of the finite points. A node holds at most kMostNodePoints, a uniform subsample
/// of the points left in its cube; so is every prefix of them (except the first few). `spacing` is
/// that of the whole cloud. Work is linear in the points but for the depth of the tree, at most 21
/// levels.
Layout make_layout(std::span<const Vec3> positions, double spacing);

/// The data of a node for drawing: points x uint16[3] (place in the cube), points x int8[2]
/// (octahedral normal), points x uint8[3] (colour; nothing if `colours` is empty). The arguments
/// are per point of the cloud.
std::vector<std::byte> encode_points(const Layout& layout, const Node& node,
                                     std::span<const Vec3> positions, std::span<const Vec3> normals,
                                     std::span<const Rgb> colours);

}  // namespace pcednet::annotate
