#include "pcednet/lines/pieces/circles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "pcednet/core/sort_unique.h"
#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/pieces/ring.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr double kMostOpen = 0.55;        ///< of a circle that is to be closed
constexpr double kMostOpenOnEdges = 0.7;  ///< the same where edge points follow it

// Small circles are found in pieces each of which alone fits none. In spacings.
constexpr double kLargestSmall = 5.0;                ///< radius
constexpr double kLeastApart = 1.5, kOnSmall = 0.7;  ///< of two nodes; of a node from a circle
constexpr double kAcross = 1.5;                      ///< of ends on a circle
constexpr double kMostTurned = 0.28, kTurnBySpacing = 0.78;  ///< sine between node and circle
constexpr double kSmallError = 0.3;                          ///< root mean square of the nodes
constexpr std::size_t kSectors = 12, kLeastSectors = 8;
constexpr std::size_t kLeastAcross = 3;   ///< nodes of a piece that ends on a polygon
constexpr std::size_t kMostAcross = 1;    ///< pieces that end on a circle
constexpr std::size_t kLeastOff = 2;      ///< nodes beyond the end of an arc
constexpr std::size_t kMostLeaving = 1;   ///< pieces that lead on from a circle
constexpr std::size_t kNearlyWhole = 11;  ///< sectors of a circle, whatever leads on from it

bool most_nodes_lie_on(const Fit& circle, const Piece& whole, const Piece& piece, double reach) {
  std::size_t on = 0;
  for (const ChainNode& node : piece.nodes) {
    const Vec3 nearest = nearest_on(circle, node.at);
    on += (nearest - node.at).norm() < reach * node.spacing &&
          std::abs(tangent_at(circle, node.at).dot(node.along)) > 0.8 &&
          same_wedge(circle, whole.middle(), node);
  }
  return 5 * on >= 4 * piece.nodes.size();
}

/// The pieces on the circle of `arc`, itself among them, in their order.
std::vector<std::size_t> pieces_on_circle(const std::vector<Piece>& pieces, const PieceIndex& index,
                                          std::size_t arc, double reach) {
  const Piece& whole = pieces[arc];
  std::vector<spatial::Neighbour> near;
  index.starts.within_unsorted(whole.fit.point, whole.fit.radius + 3.0 * whole.spacing(), near);
  std::vector<std::size_t> found = {arc};
  for (const auto& start : near) {
    const std::size_t j = start.index;
    if (j == arc || pieces[j].closed) continue;
    if (most_nodes_lie_on(whole.fit, whole, pieces[j], reach)) found.push_back(j);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The circle that `arc` is of, with all pieces on it (`joined`); nothing if it is not to be
/// closed.
std::optional<Piece> completed(const std::vector<Piece>& pieces, const PieceIndex& index,
                               const OrderedPoints& cloud, std::size_t arc, double tolerance,
                               std::vector<std::size_t>& joined) {
  Piece whole = pieces[arc];
  joined = pieces_on_circle(pieces, index, arc, 3.0 * tolerance);
  for (const std::size_t j : joined) {
    if (j == arc) continue;
    whole.nodes.insert(whole.nodes.end(), pieces[j].nodes.begin(), pieces[j].nodes.end());
  }
  const Fit fit = fit_arc(whole.nodes);
  if (fit.kind != CurveKind::kArc || fit.error > 2.0 * tolerance) return std::nullopt;
  if (!whole.exact) whole.fit = fit;
  const std::vector<Gap> gaps = sort_about_axis(whole.fit, whole.nodes);
  double open = 0.0;
  for (const Gap& gap : gaps) open += gap.length;
  const double share = open / (kWholeTurn * whole.fit.radius);
  if (share > kMostOpenOnEdges) return std::nullopt;
  if (!edges_follow(whole.fit, gaps, whole.spacing(), cloud)) {
    if (share > kMostOpen || is_blocked(gaps, pieces, index, joined)) return std::nullopt;
  }
  whole.closed = true;
  whole.ends = {whole.nodes.front().at, whole.nodes.front().at};
  return whole;
}

/// The circle through two nodes that has the first one's direction there; nothing if it is not
/// small or the second has another direction or wedge.
std::optional<Fit> small_circle(const ChainNode& a, const ChainNode& b) {
  const Vec3 offset = b.at - a.at, across = offset - offset.dot(a.along) * a.along;
  const double apart = across.norm(), spacing = a.spacing;
  if (offset.norm() < kLeastApart * spacing || !(apart > 0.0)) return std::nullopt;
  const double radius = offset.squaredNorm() / (2.0 * apart);
  if (radius > kLargestSmall * spacing || radius < kSmallestRadius * spacing) return std::nullopt;
  const Vec3 inward = across / apart;
  return Fit{CurveKind::kArc, a.at + radius * inward, a.along.cross(inward), radius, 0.0};
}

bool lies_on(const Fit& circle, const ChainNode& like, const ChainNode& node) {
  return (nearest_on(circle, node.at) - node.at).norm() < kOnSmall * node.spacing &&
         std::abs(tangent_at(circle, node.at).dot(node.along)) > 0.8 &&
         same_wedge(circle, like, node);
}

/// A small circle and the nodes on it.
struct SmallCircle {
  Fit fit;
  std::vector<ChainNode> nodes;
  std::size_t sectors = 0;  ///< of kSectors equal ones, those with nodes
};

SmallCircle nodes_on(const Fit& circle, const ChainNode& like,
                     std::span<const ChainNode* const> near) {
  SmallCircle found{.fit = circle, .nodes = {}};
  Sectors sectors(circle, kSectors);
  for (const ChainNode* node : near) {
    if (!lies_on(circle, like, *node)) continue;
    sectors.add(node->at);
    found.nodes.push_back(*node);
  }
  found.sectors = sectors.covered();
  return found;
}

/// Whether the nodes turn as the circle does: those of a polygon keep to its sides. The fewer
/// nodes, the less certain their directions are.
bool turns(const SmallCircle& circle) {
  double sum = 0.0;
  for (const ChainNode& node : circle.nodes) {
    sum += tangent_at(circle.fit, node.at).cross(node.along).squaredNorm();
  }
  const double sine = std::sqrt(sum / static_cast<double>(circle.nodes.size()));
  const double radius = circle.fit.radius / circle.nodes.front().spacing;
  return sine < std::max(kMostTurned, kTurnBySpacing / radius);
}

/// The circle through `node` that explains the most of the nodes near it, fitted to them.
std::optional<SmallCircle> best_small_circle(const ChainNode& node,
                                             std::span<const ChainNode* const> near) {
  SmallCircle best;
  for (const ChainNode* other : near) {
    const auto circle = small_circle(node, *other);
    if (!circle || !lies_on(*circle, node, *other)) continue;
    SmallCircle found = nodes_on(*circle, node, near);
    const bool more = found.sectors > best.sectors ||
                      (found.sectors == best.sectors && found.nodes.size() > best.nodes.size());
    if (more) best = std::move(found);
  }
  for (int round = 0; round < 2; ++round) {
    if (best.sectors + 1 < kLeastSectors) return std::nullopt;
    sort_about_axis(best.fit, best.nodes);
    const Fit fit = fit_arc(best.nodes);
    if (fit.kind != CurveKind::kArc) return std::nullopt;
    best = nodes_on(fit, node, near);
  }
  const bool small = best.fit.radius < 1.2 * kLargestSmall * node.spacing &&
                     best.fit.radius > kSmallestRadius * node.spacing;
  if (!small || best.sectors < kLeastSectors || best.fit.error > kSmallError || !turns(best)) {
    return std::nullopt;
  }
  return best;
}

/// Whether pieces across the circle end on it: it is a polygon.
bool is_polygon(const Fit& circle, const std::vector<Piece>& pieces,
                const std::vector<std::size_t>& near) {
  std::size_t across = 0;
  for (const std::size_t j : near) {
    const Piece& piece = pieces[j];
    if (piece.closed || piece.nodes.size() < kLeastAcross || belongs_to(circle, piece)) continue;
    for (const std::size_t side : {0, 1}) {
      const Vec3& end = piece.ends[side];
      across += (nearest_on(circle, end) - end).norm() < kAcross * piece.spacing() &&
                std::abs(outward(piece, side).dot(circle.direction)) > 0.8;
    }
  }
  return across > kMostAcross;
}

/// How many ends of the piece lead off the circle from nodes on it: the arc at the end of a slot
/// goes on as a line.
std::size_t ends_off(const Fit& circle, const ChainNode& like, const Piece& piece) {
  const auto& nodes = piece.nodes;
  const auto is_on = [&](const ChainNode& node) { return lies_on(circle, like, node); };
  const auto first = std::find_if(nodes.begin(), nodes.end(), is_on);
  if (first == nodes.end()) return 0;
  const auto last = std::find_if(nodes.rbegin(), nodes.rend(), is_on);
  const auto before = static_cast<std::size_t>(first - nodes.begin());
  const auto after = static_cast<std::size_t>(last - nodes.rbegin());
  return static_cast<std::size_t>(before >= kLeastOff) +
         static_cast<std::size_t>(after >= kLeastOff);
}

/// Whether the circle is only the arc at the end of a slot or a rounded corner.
bool is_arc_between_lines(const SmallCircle& circle, const ChainNode& like,
                          const std::vector<Piece>& pieces, const std::vector<std::size_t>& near) {
  if (circle.sectors >= kNearlyWhole) return false;
  std::size_t leaving = 0;
  for (const std::size_t j : near) leaving += ends_off(circle.fit, like, pieces[j]);
  return leaving > kMostLeaving;
}

/// Puts circles in place of the pieces that are of small ones.
void find_small_circles(std::vector<Piece>& pieces) {
  std::vector<Piece> circles;
  std::vector<std::uint8_t> gone(pieces.size(), 0);
  const NodeIndex index(pieces);
  std::vector<spatial::Neighbour> found;
  for (const std::size_t i : longest_first(pieces)) {
    const Piece& piece = pieces[i];
    const double reach = 2.0 * (kLargestSmall + 1.0) * piece.spacing();
    if (gone[i] || piece.closed || length_of(piece) > std::numbers::pi * reach) continue;
    index.tree.within(piece.middle().at, reach, found);
    std::vector<const ChainNode*> near;
    std::vector<std::size_t> of_pieces;
    for (const auto& other : found) {
      const std::size_t j = index.piece[other.index];
      if (gone[j] || pieces[j].closed) continue;
      near.push_back(index.nodes[other.index]);
      of_pieces.push_back(j);
    }
    const auto circle = best_small_circle(piece.middle(), near);
    if (!circle) continue;
    sort_unique(of_pieces);
    if (is_polygon(circle->fit, pieces, of_pieces)) continue;
    if (is_arc_between_lines(*circle, piece.middle(), pieces, of_pieces)) continue;
    Piece whole{.fit = circle->fit, .nodes = circle->nodes, .ends = {}, .closed = true};
    sort_about_axis(whole.fit, whole.nodes);
    whole.ends = {whole.nodes.front().at, whole.nodes.front().at};
    for (const std::size_t j : of_pieces) gone[j] = belongs_to(whole.fit, pieces[j]);
    circles.push_back(std::move(whole));
  }
  erase_marked(pieces, gone);
  pieces.insert(pieces.end(), circles.begin(), circles.end());
}
}  // namespace

void complete_circles(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance) {
  find_small_circles(pieces);
  const PieceIndex index(pieces);
  std::vector<std::uint8_t> gone(pieces.size(), 0);
  std::vector<std::size_t> joined;
  for (const std::size_t i : longest_first(pieces)) {
    const Piece& piece = pieces[i];
    if (gone[i] || piece.closed || piece.fit.kind != CurveKind::kArc) continue;
    if (piece.nodes.size() < kLeastArc || piece.fit.radius < kSmallestRadius * piece.spacing()) {
      continue;
    }
    auto circle = completed(pieces, index, cloud, i, tolerance, joined);
    if (!circle) continue;
    for (const std::size_t j : joined) {
      if (j == i) continue;
      gone[j] = 1;
      pieces[j].closed = true;  // not to be joined again
    }
    pieces[i] = std::move(*circle);
  }
  erase_marked(pieces, gone);
}

}  // namespace pcednet::lines
