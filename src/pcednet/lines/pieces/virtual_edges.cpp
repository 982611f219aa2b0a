#include "pcednet/lines/pieces/virtual_edges.h"

#include <cmath>
#include <cstdint>

namespace pcednet::lines {
namespace {

/// How far the edges of the chamfer are from the piece, in spacings.
constexpr double kNearest = 0.3, kFarthest = 3.0;
constexpr double kAhead = 1.0;            ///< along the piece, to the next node
constexpr double kSameDirection = 0.966;  ///< 15 degrees
constexpr double kSameFace = 0.9;         ///< 26 degrees
constexpr double kTowardsFace = 0.5;      ///< 60 degrees
constexpr double kMostNodes = 0.6;        ///< of the piece

/// Whether `edge` lies on the face that goes from `node` in the direction `face`, and is the end of
/// it on this side: the face goes on from there, and the other side is not `other_face`.
bool ends_face(const ChainNode& node, const Vec3& face, const Vec3& other_face,
               const ChainNode& edge) {
  const Vec3 offset = edge.at - node.at;
  const double ahead = offset.dot(node.along);
  const Vec3 across = offset - ahead * node.along;
  const double distance = across.norm();
  if (std::abs(ahead) > kAhead * node.spacing || distance < kNearest * node.spacing ||
      distance > kFarthest * node.spacing || across.dot(face) < kTowardsFace * distance ||
      std::abs(edge.along.dot(node.along)) < kSameDirection) {
    return false;
  }
  const auto is_end = [&](const Vec3& side, const Vec3& other_side) {
    return side.dot(face) >= kSameFace && other_side.dot(other_face) < kSameFace;
  };
  return is_end(edge.side_a, edge.side_b) || is_end(edge.side_b, edge.side_a);
}

/// The piece with its nodes on its curve.
Piece on_curve(Piece piece) {
  if (piece.fit.kind == CurveKind::kPolyline) return piece;
  for (ChainNode& node : piece.nodes) node.at = nearest_on(piece.fit, node.at);
  return piece;
}

}  // namespace

void drop_virtual_edges(std::vector<Piece>& pieces) {
  std::vector<Piece> placed;
  for (const Piece& piece : pieces) placed.push_back(on_curve(piece));
  const NodeIndex index(placed);
  std::vector<std::uint8_t> is_virtual(pieces.size(), 0);
  std::vector<spatial::Neighbour> near;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (placed[i].exact || is_boundary(placed[i].middle())) continue;
    double over = 0.0;
    for (const ChainNode& node : placed[i].nodes) {
      index.tree.within_unsorted(node.at, std::hypot(kFarthest, kAhead) * node.spacing, near);
      bool on_a = false, on_b = false;
      for (const spatial::Neighbour& found : near) {
        const ChainNode& edge = *index.nodes[found.index];
        if (index.piece[found.index] == i || is_boundary(edge)) continue;
        on_a = on_a || ends_face(node, node.side_a, node.side_b, edge);
        on_b = on_b || ends_face(node, node.side_b, node.side_a, edge);
      }
      over += on_a && on_b ? 1.0 : 0.0;
    }
    is_virtual[i] = over >= kMostNodes * static_cast<double>(placed[i].nodes.size());
  }
  erase_marked(pieces, is_virtual);
}

}  // namespace pcednet::lines
