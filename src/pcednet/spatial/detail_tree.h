#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcednet::spatial {

/// A point of a cube that is cut into 2^21 cells a side.
struct TreePoint {
  std::uint64_t key = 0;    ///< morton_code of its cell
  std::uint32_t tie = 0;    ///< decides among points of one cell
  std::uint32_t index = 0;  ///< the caller's number of the point, below the number of points
};

struct DetailTreeOptions {
  std::size_t most = 100'000;  ///< points that a cell keeps without children
  std::size_t least = 10'000;  ///< a childless node of fewer goes to its parent if that has room
};

/// A cell of the octree that holds points: cell (x, y, z) of the 2^depth a side.
struct DetailNode {
  int depth = 0;
  std::array<std::uint32_t, 3> cell = {};
  std::size_t points = 0;
};

/// An octree of levels of detail: every point is in exactly one node, and the nodes of the first
/// levels are an even sample of the cloud.
struct DetailTree {
  std::vector<DetailNode> nodes;  ///< parents before children, level by level; never empty
  /// The rank of each point, by its index, when the nodes' points are concatenated: within a node
  /// by key, then tie.
  std::vector<std::uint32_t> places;
};

/// A node of more than `most` points keeps the one nearest to the centre of each voxel that has
/// any, of 128 voxels a side (64 or 32 where that would be more than `most`), and hands the rest to
/// its children. More than `most` points closer together than 2^-16 of the cube make nodes without
/// an even sample: 2^20 of them each, and all that are left at depth 21.
///
/// The tree does not depend on the number of threads, nor on the order of the points as long as
/// points of equal key and tie are interchangeable. Takes 20 bytes a point, 16 of which are
/// `points`.
DetailTree make_detail_tree(std::vector<TreePoint> points, const DetailTreeOptions& options = {});

}  // namespace pcednet::spatial
