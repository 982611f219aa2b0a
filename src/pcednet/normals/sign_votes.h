#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

/// Points, the links between them, and a unit normal (or zero) for each.
struct SignVotes {
  std::span<const Vec3> points;
  std::span<const Vec3> normals;
  const Adjacency& links;

  /// How strongly the normals of two linked points speak for equal signs (negative: for opposite
  /// ones), see orient.h; 0 if one of them is zero. A whole number, so that sums of votes do not
  /// depend on their order, at most kUnanimous * 2.8 in size.
  std::int64_t vote(std::size_t i, std::size_t j) const;

  static constexpr double kUnanimous = 1 << 20;
};

/// Which points turn their normal about, and what they are connected to.
struct Signs {
  std::vector<std::int8_t> sign;    ///< per point, 1 or -1
  std::vector<std::uint32_t> part;  ///< per point, in the order of the parts' first points
  std::size_t parts = 0;
};

/// Contracts the graph along the strongest sums of votes (Boruvka's rounds). Points with a zero
/// normal are parts by themselves.
Signs contract(const SignVotes& votes);

/// Turns single points as long as their neighbours outvote them.
void turn_outvoted_points(const SignVotes& votes, std::vector<std::int8_t>& sign);

}  // namespace pcednet::normals
