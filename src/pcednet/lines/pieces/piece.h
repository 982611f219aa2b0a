#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pcednet/lines/curves/fit.h"
#include "pcednet/lines/curves/split.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {

/// The least tolerance of boundaries, in spacings: the end of the points is a matter of chance.
inline constexpr double kBoundaryTolerance = 0.4;

/// One curve in the making.
struct Piece {
  Fit fit;
  std::vector<ChainNode> nodes;
  std::array<Vec3, 2> ends;  ///< on the fit; unused if closed
  bool closed = false;
  std::optional<double> dihedral = {};  ///< between the fitted surfaces, radians; else of the nodes
  bool exact = false;                   ///< where exact surfaces meet: it keeps its line or circle
  bool rounded = false;                 ///< a fillet, whose class is smooth-edge
  bool regular = false;  ///< a segment whose direction is to be kept, see regularise()

  const ChainNode& middle() const { return nodes[nodes.size() / 2]; }
  double spacing() const { return middle().spacing; }
};

inline bool is_boundary(const ChainNode& node) {
  return node.boundary > 0.5;
}

inline bool is_exact_arc(const Piece& piece) {
  return piece.exact && piece.fit.kind == CurveKind::kArc;
}

/// `tolerance` (in spacings), or that of boundaries if the node is on one.
inline double tolerance_at(const ChainNode& node, double tolerance) {
  return is_boundary(node) ? std::max(tolerance, kBoundaryTolerance) : tolerance;
}

/// The node at an end of the piece: 0, its first, or 1, its last.
inline const ChainNode& node_at(const Piece& piece, std::size_t side) {
  return side == 0 ? piece.nodes.front() : piece.nodes.back();
}

/// The direction of the node's curve at `place`, in the node's sense; the direction of the node if
/// there is neither line nor circle.
Vec3 along_at(const Fit& fit, const ChainNode& node, const Vec3& place);

/// The direction in which the piece would continue beyond an end.
Vec3 outward(const Piece& piece, std::size_t side);

/// Whether the wedges at two nodes belong to one edge.
bool same_wedge(const ChainNode& a, const ChainNode& b);

/// An end of a piece.
struct End {
  std::size_t piece;
  std::size_t side;
};

/// Both ends of every piece that is not closed.
std::vector<End> open_ends(const std::vector<Piece>& pieces);

/// Ends of pieces, to be found by place.
struct EndIndex {
  EndIndex(const std::vector<Piece>& pieces, std::vector<End> of_these);

  std::vector<End> ends;
  std::vector<Vec3> places;  ///< of each end
  spatial::KdTree tree;
};

/// All nodes of all pieces, to be found by place.
struct NodeIndex {
  explicit NodeIndex(const std::vector<Piece>& pieces);

  std::vector<const ChainNode*> nodes;
  std::vector<std::size_t> piece;  ///< of each node
  spatial::KdTree tree;
};

/// The numbers of the pieces, those with the most nodes first.
std::vector<std::size_t> longest_first(const std::vector<Piece>& pieces);

/// Removes the pieces that are marked.
void erase_marked(std::vector<Piece>& pieces, const std::vector<std::uint8_t>& marks);

/// Appends pieces.
inline void append(std::vector<Piece>& pieces, std::vector<Piece> more) {
  for (Piece& piece : more) pieces.push_back(std::move(piece));
}

/// Appends the nodes, in their order or turned round.
void append(std::vector<ChainNode>& nodes, const std::vector<ChainNode>& more, bool in_order);

/// The pieces of a chain; those of fewer than `least_nodes` nodes are left out.
std::vector<Piece> pieces_of(const Chain& chain, const std::vector<Run>& runs,
                             std::size_t least_nodes);

/// Length between the ends.
double length_of(const Piece& piece);

/// Both pieces as one, joined at these ends, which may face each other at any distance; none if no
/// segment or arc fits both. `tolerance` is in spacings.
std::optional<Piece> joined_at(const Piece& a, std::size_t side_a, const Piece& b,
                               std::size_t side_b, double tolerance);

/// Drops, of exact pieces, those most of whose nodes are on longer ones: the wall of a mesh may
/// have been taken for several cylinders.
void drop_exact_copies(std::vector<Piece>& pieces);

/// Drops the pieces beside exact ones.
void drop_beside_exact(std::vector<Piece>& pieces);

/// Joins pieces that lie on one line or circle and continue each other over gaps up to `gap`, and
/// drops those that lie on a longer one. `tolerance` is in spacings. Throws Error(kCancelled) once
/// the caller cancels.
void join_pieces(std::vector<Piece>& pieces, double gap, double tolerance,
                 const Progress* progress = nullptr);

}  // namespace pcednet::lines
