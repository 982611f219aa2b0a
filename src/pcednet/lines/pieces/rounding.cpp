#include "pcednet/lines/pieces/rounding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace pcednet::lines {
namespace {

constexpr double kLeastTurn = 0.906, kMostTurn = -0.866;  ///< cosines: of 25 and 150 degrees
constexpr double kOnwards = 0.25;   ///< least cosine between a piece and the segment that follows
constexpr double kAlongside = 0.8;  ///< an edge along the piece does not begin there
constexpr double kMisses = 1.4;     ///< tolerances between nodes and arc
constexpr std::size_t kLeastNodesOfSegment = 3, kLeastNodesLeft = 2, kLeastNodesOnArc = 2;

// In spacings.
constexpr double kLongestRounding = 24.0;  ///< of the piece, and of the tangents
constexpr double kToSegment = 4.5;         ///< from the piece between to a segment
constexpr double kToOthers = 2.5;          ///< from the piece between to other edges
constexpr double kLinesApart = 0.6;        ///< and the tolerance
constexpr double kLeastRounding = 1.5;
constexpr double kRestOfSegment = 2.0;
constexpr double kTangentStep = 0.25;
constexpr double kMostOffArc = 3.0;
constexpr double kWallFrom = 0.6, kWallTo = 3.5;  ///< of the wall, from the edge's plane
constexpr double kOnWall = 1.0;                   ///< its points from the edge, seen along the axis
constexpr double kBesideArc = 5.0;                ///< of the wall beyond the ends of the arc
constexpr double kRadiusStep = 0.05, kMostMoved = 3.0;  ///< of the tangent
constexpr double kMostLean = 0.15;                      ///< of the wall from the lines, on average
constexpr std::size_t kLeastOfWall = 8;                 ///< points beside the arc

/// Where two lines meet, and the arcs that touch both at the distance `tangent` from there.
struct Apex {
  Vec3 at;
  Vec3 in, out;  ///< directions of the line up to it and of the one from it on
  Vec3 axis;     ///< of the turn, counter-clockwise
  double turn;

  double radius(double tangent) const { return tangent / std::tan(0.5 * turn); }
  Vec3 first(double tangent) const { return at - tangent * in; }
  Vec3 last(double tangent) const { return at + tangent * out; }
  Vec3 centre(double tangent) const { return first(tangent) + radius(tangent) * axis.cross(in); }

  /// Whether the place is beside the arc, not beside one of the lines.
  bool is_on_arc(const Vec3& place, double tangent) const {
    return (place - first(tangent)).dot(in) > 0.0 && (place - last(tangent)).dot(out) < 0.0;
  }
  double distance_to_arc(const Vec3& place, double tangent) const {
    const Vec3 offset = place - centre(tangent);
    const double height = offset.dot(axis);
    return std::hypot((offset - height * axis).norm() - radius(tangent), height);
  }
  /// Outwards from the arc or, beside a line, from that, seen along the axis.
  double outside(const Vec3& place, double tangent) const {
    const Vec3 flat = place - (place - at).dot(axis) * axis;
    if (is_on_arc(flat, tangent)) return (flat - centre(tangent)).norm() - radius(tangent);
    const Vec3& along = (flat - at).dot(in + out) > 0.0 ? out : in;
    return -(flat - at).dot(axis.cross(along));
  }
  /// To the nearer of the lines.
  double distance_to_lines(const Vec3& place) const {
    const Vec3 offset = place - at;
    return std::min(offset.cross(in).norm(), offset.cross(out).norm());
  }
};

/// The piece between two segments, and their ends at its first and its last.
struct Between {
  std::size_t piece;
  End before, after;
};

/// The segment that goes on nearest to an end of a piece.
std::optional<End> segment_at(const End& end, const std::vector<Piece>& pieces,
                              const EndIndex& index) {
  const Piece& piece = pieces[end.piece];
  std::vector<spatial::Neighbour> near;
  index.tree.within(piece.ends[end.side], kToSegment * piece.spacing(), near);
  for (const auto& other : near) {
    const End& there = index.ends[other.index];
    const Piece& segment = pieces[there.piece];
    if (there.piece == end.piece || segment.fit.kind != CurveKind::kSegment) continue;
    if (segment.nodes.size() < kLeastNodesOfSegment || is_boundary(segment.middle())) continue;
    if (length_of(segment) < length_of(piece)) continue;
    if (-outward(segment, there.side).dot(outward(piece, end.side)) < kOnwards) continue;
    return there;
  }
  return std::nullopt;
}

/// Whether an edge that is none of the three begins at an end of the piece.
bool is_junction(const Between& between, std::size_t side, const std::vector<Piece>& pieces,
                 const EndIndex& index) {
  const Piece& piece = pieces[between.piece];
  std::vector<spatial::Neighbour> near;
  index.tree.within(piece.ends[side], kToOthers * piece.spacing(), near);
  return std::any_of(near.begin(), near.end(), [&](const auto& other) {
    const auto [of, at] = index.ends[other.index];
    if (of == between.piece || of == between.before.piece || of == between.after.piece)
      return false;
    return std::abs(outward(pieces[of], at).dot(outward(piece, side))) < kAlongside;
  });
}

std::optional<Between> between_segments(std::size_t piece, const std::vector<Piece>& pieces,
                                        const EndIndex& index) {
  const auto before = segment_at({piece, 0}, pieces, index);
  const auto after = segment_at({piece, 1}, pieces, index);
  if (!before || !after || before->piece == after->piece) return std::nullopt;
  const Between between = {piece, *before, *after};
  if (is_junction(between, 0, pieces, index) || is_junction(between, 1, pieces, index))
    return std::nullopt;
  return between;
}

/// Nothing where the lines pass each other farther than `apart`, or turn too little or too much.
std::optional<Apex> apex_of(const Piece& before, std::size_t side_before, const Piece& after,
                            std::size_t side_after, double apart) {
  const Vec3 in = outward(before, side_before), out = -outward(after, side_after);
  const double cosine = in.dot(out);
  if (!(cosine < kLeastTurn && cosine > kMostTurn)) return std::nullopt;
  const Vec3 &from = before.ends[side_before], &to = after.ends[side_after];
  const Vec3 axis = in.cross(out).normalized(), offset = to - from;
  if (std::abs(offset.dot(axis)) > apart) return std::nullopt;
  const double sq_sine = 1.0 - cosine * cosine;
  const double ahead = (offset.dot(in) - cosine * offset.dot(out)) / sq_sine;
  const double behind = (offset.dot(out) - cosine * offset.dot(in)) / sq_sine;
  return Apex{0.5 * (from + ahead * in + to - behind * out), in, out, axis, std::acos(cosine)};
}

/// The nodes of all three that may be on an arc with a tangent up to `most`, in the order and the
/// sense of the edge.
std::vector<ChainNode> nodes_along(const Between& between, const std::vector<Piece>& pieces,
                                   const Apex& apex, double most) {
  std::vector<ChainNode> nodes;
  append(nodes, pieces[between.before.piece].nodes, between.before.side == 1);
  append(nodes, pieces[between.piece].nodes, true);
  append(nodes, pieces[between.after.piece].nodes, between.after.side == 0);
  std::erase_if(nodes, [&](const ChainNode& node) { return !apex.is_on_arc(node.at, most); });
  return nodes;
}

/// The tangent of the arc that with the lines is nearest to the nodes, by least squares.
std::optional<double> best_tangent(const Apex& apex, const std::vector<ChainNode>& nodes,
                                   double spacing, double most) {
  std::optional<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (double tangent = kTangentStep * spacing; tangent < most; tangent += kTangentStep * spacing) {
    if (apex.radius(tangent) < kLeastRounding * spacing) continue;
    double sum = 0.0;
    for (const ChainNode& node : nodes) {
      const double off = apex.is_on_arc(node.at, tangent) ? apex.distance_to_arc(node.at, tangent)
                                                          : apex.distance_to_lines(node.at);
      sum += std::pow(std::min(off / spacing, kMostOffArc), 2);
    }
    if (sum < least) least = sum, best = tangent;
  }
  return best;
}

/// The points of the wall across the edge, on that side of its plane where more are.
std::vector<Vec3> wall_of(const Apex& apex, double tangent, const OrderedPoints& cloud,
                          double spacing) {
  std::vector<spatial::Neighbour> near;
  cloud.within(apex.at, tangent + (kBesideArc + kWallTo) * spacing, near);
  const double most = tangent + kBesideArc * spacing;
  std::vector<Vec3> below, above;
  for (const auto& point : near) {
    const Vec3& place = cloud.position(point.index);
    const Vec3 offset = place - apex.at;
    const double height = offset.dot(apex.axis) / spacing;
    if (std::abs(height) < kWallFrom || std::abs(height) > kWallTo) continue;
    if (offset.dot(apex.in) < -most || offset.dot(apex.out) > most) continue;
    if (std::abs(apex.outside(place, tangent)) > kOnWall * spacing) continue;
    (height > 0.0 ? above : below).push_back(place);
  }
  return above.size() > below.size() ? above : below;
}

/// The tangent of the arc that is nearest to the wall, by least squares; `tangent` where the wall
/// is not across the plane of the edge or has few points. Nodes of noisy points lie inside of a
/// convex arc.
double tangent_of_wall(const Apex& apex, double tangent, double most, std::span<const Vec3> wall,
                       double spacing) {
  double lean = 0.0, beside = 0.0;
  for (const Vec3& place : wall) {
    if (apex.is_on_arc(place, tangent)) continue;
    lean += apex.outside(place, tangent) / spacing;
    beside += 1.0;
  }
  const double on_arc = static_cast<double>(wall.size()) - beside;
  if (on_arc < kLeastOfWall || beside < kLeastOfWall || std::abs(lean) > kMostLean * beside) {
    return tangent;
  }
  double best = tangent, least = std::numeric_limits<double>::infinity();
  const int steps = static_cast<int>(kMostMoved / kRadiusStep);
  for (int step = -steps; step <= steps; ++step) {
    const double other = tangent + step * kRadiusStep * spacing;
    if (other > most || apex.radius(other) < kLeastRounding * spacing) continue;
    double sum = 0.0;
    for (const Vec3& place : wall) sum += std::pow(apex.outside(place, other), 2);
    if (sum < least) least = sum, best = other;
  }
  return best;
}

/// The segment up to the arc; nothing if hardly a node is left.
std::optional<Piece> shortened(const Piece& segment, std::size_t side, const Vec3& end,
                               const Apex& apex, double tangent) {
  Piece rest = segment;
  std::erase_if(rest.nodes,
                [&](const ChainNode& node) { return apex.is_on_arc(node.at, tangent); });
  if (rest.nodes.size() < kLeastNodesLeft) return std::nullopt;
  rest.ends[side] = end;
  return rest;
}

/// The arc with the nodes beside it; nothing if there are few, or `most_off` spacings from it.
std::optional<Piece> arc_at(const Apex& apex, double tangent, const std::vector<ChainNode>& nodes,
                            double spacing, double most_off) {
  Piece arc{.fit = {CurveKind::kArc, apex.centre(tangent), apex.axis, apex.radius(tangent)},
            .nodes = {},
            .ends = {apex.first(tangent), apex.last(tangent)}};
  double sum = 0.0;
  for (const ChainNode& node : nodes) {
    if (!apex.is_on_arc(node.at, tangent)) continue;
    arc.nodes.push_back(node);
    sum += std::pow(apex.distance_to_arc(node.at, tangent) / spacing, 2);
  }
  if (arc.nodes.size() < kLeastNodesOnArc) return std::nullopt;
  arc.fit.error = std::sqrt(sum / static_cast<double>(arc.nodes.size()));
  if (arc.fit.error > most_off) return std::nullopt;
  return arc;
}

void round_corner(const Between& between, const OrderedPoints& cloud, double tolerance,
                  std::vector<Piece>& pieces) {
  Piece& piece = pieces[between.piece];
  const auto [before, side_before] = between.before;
  const auto [after, side_after] = between.after;
  const double spacing = piece.spacing();
  const auto apex = apex_of(pieces[before], side_before, pieces[after], side_after,
                            (kLinesApart + tolerance) * spacing);
  if (!apex) return;
  const double room = std::min((apex->at - pieces[before].ends[1 - side_before]).dot(apex->in),
                               (pieces[after].ends[1 - side_after] - apex->at).dot(apex->out));
  const double most = std::min(room - kRestOfSegment * spacing, kLongestRounding * spacing);
  const std::vector<ChainNode> nodes = nodes_along(between, pieces, *apex, most);
  auto tangent = best_tangent(*apex, nodes, spacing, most);
  if (!tangent) return;
  tangent =
      tangent_of_wall(*apex, *tangent, most, wall_of(*apex, *tangent, cloud, spacing), spacing);
  auto arc =
      arc_at(*apex, *tangent, nodes, spacing, std::max(kMisses * tolerance, piece.fit.error));
  auto up_to = shortened(pieces[before], side_before, apex->first(*tangent), *apex, *tangent);
  auto from_on = shortened(pieces[after], side_after, apex->last(*tangent), *apex, *tangent);
  if (!arc || !up_to || !from_on) return;
  piece = std::move(*arc);
  pieces[before] = std::move(*up_to);
  pieces[after] = std::move(*from_on);
}

}  // namespace

void round_corners(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance) {
  const EndIndex index(pieces, open_ends(pieces));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    if (piece.closed || piece.exact || is_boundary(piece.middle())) continue;
    if (length_of(piece) > kLongestRounding * piece.spacing()) continue;
    if (const auto between = between_segments(i, pieces, index)) {
      round_corner(*between, cloud, tolerance, pieces);
    }
  }
}

}  // namespace pcednet::lines
