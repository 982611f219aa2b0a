#include "pcednet/lines/pieces/extent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/pieces/corners.h"
#include "pcednet/lines/pieces/mean_sides.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLeastToExtend = 5;  ///< nodes
constexpr std::size_t kNodesOfSides = 10;  ///< from the end, that tell the sides

// In spacings.
constexpr double kBack = 4.0;         ///< from the end to where the walk begins
constexpr double kFarthestOn = 25.0;  ///< that an end is moved on; nor by more than the length
constexpr double kStripFrom = 0.5, kStripTo = 3.0;  ///< of the points of a side, from the edge
constexpr double kOnSide[] = {0.3, 1.2};  ///< from its plane; the second per spacing of noise
constexpr double kEmptyRun = 2.0;         ///< without points of a side: it ends
constexpr double kEndOfRun = 0.2;         ///< from its last point to its end, the mean
constexpr double kBesideOther = 1.2, kParallel = 0.8;  ///< of an edge found already

/// An end of a piece and the frame that goes along with it: `first` and `second` are across it.
struct Track {
  const Fit& fit;
  Vec3 end;
  double sense;        ///< of the tangent: 1 or -1
  Vec3 first, second;  ///< at the end; those of an arc turn with it

  Vec3 at(double along) const {
    if (fit.kind == CurveKind::kSegment) return end + sense * along * fit.direction;
    const Eigen::AngleAxisd turn(sense * along / fit.radius, fit.direction);
    return fit.point + turn * (end - fit.point);
  }
  double along(const Vec3& place) const {
    if (fit.kind == CurveKind::kSegment) return sense * (place - end).dot(fit.direction);
    const Vec3 from = end - fit.point, to = place - fit.point;
    return sense * fit.radius *
           std::atan2(fit.direction.dot(from.cross(to)),
                      from.dot(to - to.dot(fit.direction) * fit.direction));
  }
  /// A direction at `place` seen across the curve.
  Eigen::Vector2d across(const Vec3& place, const Vec3& direction) const {
    if (fit.kind == CurveKind::kSegment) return {direction.dot(first), direction.dot(second)};
    const Vec3 offset = place - fit.point;
    const Vec3 out = (offset - offset.dot(fit.direction) * fit.direction).stableNormalized();
    return {direction.dot(out), direction.dot(fit.direction)};
  }
};

Track track_of(const Piece& piece, std::size_t side) {
  const Vec3 out = outward(piece, side);
  const double sense = tangent_at(piece.fit, piece.ends[side]).dot(out) < 0.0 ? -1.0 : 1.0;
  const Vec3 first = piece.fit.direction.unitOrthogonal();
  return {piece.fit, piece.ends[side], sense, first, piece.fit.direction.cross(first)};
}

/// Both sides seen across the curve, from the nodes at the end; nothing if they turn.
std::optional<Sides> sides_of(const Track& track, const Piece& piece, std::size_t side) {
  std::vector<Sides> sides;
  const std::size_t count = piece.nodes.size();
  for (std::size_t i = 0; i < std::min(count, kNodesOfSides); ++i) {
    const ChainNode& node = piece.nodes[side == 0 ? i : count - 1 - i];
    sides.push_back({track.across(node.at, node.side_a), track.across(node.at, node.side_b)});
  }
  return mean_sides(sides, 0.9);
}

/// How far along the track the points of a side go without a gap.
double end_of_run(std::vector<double>& places, double from, double spacing) {
  std::sort(places.begin(), places.end());
  double last = from;
  for (const double place : places) {
    if (place > last + kEmptyRun * spacing) break;
    last = place;
  }
  return last;
}

/// The indices of the points beside the track, each once.
std::vector<std::uint32_t> points_along(const Track& track, double from, double to, double spacing,
                                        const OrderedPoints& cloud) {
  std::vector<Vec3> places;
  for (double along = from; along < to + 2.0 * spacing; along += 3.0 * spacing) {
    places.push_back(track.at(along));
  }
  return cloud.near_any(places, 1.5 * kStripTo * spacing);
}

/// How far both sides go on from the end, at most to `limit`; 0 if they do not reach it.
double extent_of(const Piece& piece, std::size_t side, double limit, const OrderedPoints& cloud,
                 double noise) {
  const double spacing = piece.spacing();
  const Track track = track_of(piece, side);
  const auto sides = sides_of(track, piece, side);
  if (!sides) return 0.0;
  const double from = -std::min(kBack * spacing, 0.5 * length_of(piece));
  const double within = (kOnSide[0] + kOnSide[1] * noise) * spacing;
  std::vector<double> on[2];
  for (const std::uint32_t i : points_along(track, from, limit, spacing, cloud)) {
    const Vec3& point = cloud.position(i);
    const Vec3 nearest = nearest_on(piece.fit, point);
    const double along = track.along(nearest);
    if (along < from || along > limit + kEmptyRun * spacing) continue;
    const Eigen::Vector2d offset = track.across(nearest, point - nearest);
    for (const std::size_t k : {0, 1}) {
      const Eigen::Vector2d& of_side = (*sides)[k];
      const double out = offset.dot(of_side);
      const double off = std::abs(offset.x() * of_side.y() - offset.y() * of_side.x());
      if (out > kStripFrom * spacing && out < kStripTo * spacing && off < within) {
        on[k].push_back(along);
      }
    }
  }
  const double end = std::min(end_of_run(on[0], from, spacing), end_of_run(on[1], from, spacing));
  if (end <= from) return 0.0;
  return std::min(end + kEndOfRun * spacing, limit);
}

/// Where another piece of the same direction begins to lie beside the track.
double limit_of(const std::vector<Piece>& pieces, const NodeIndex& index, std::size_t own,
                std::size_t side) {
  const Piece& piece = pieces[own];
  const double spacing = piece.spacing();
  const Track track = track_of(piece, side);
  double limit = std::min(kFarthestOn * spacing, length_of(piece));
  if (piece.fit.kind == CurveKind::kArc) {
    const double rest = kWholeTurn * piece.fit.radius - length_of(piece);
    limit = std::min(limit, 0.5 * rest);
  }
  std::vector<spatial::Neighbour> near;
  for (double along = 0.0; along < limit; along += spacing) {
    const Vec3 place = track.at(along);
    index.tree.within_unsorted(place, kBesideOther * spacing, near);
    for (const auto& other : near) {
      if (index.piece[other.index] == own) continue;
      const Vec3 tangent = tangent_at(piece.fit, place);
      if (std::abs(index.nodes[other.index]->along.dot(tangent)) > kParallel) return along;
    }
  }
  return limit;
}

}  // namespace

void extend_free_ends(std::vector<Piece>& pieces, const OrderedPoints& cloud, double noise) {
  const NodeIndex index(pieces);
  std::vector<std::pair<End, Vec3>> moved;
  for (const End& end : free_ends(pieces, noise)) {
    const Piece& piece = pieces[end.piece];
    if (piece.fit.kind == CurveKind::kPolyline || piece.nodes.size() < kLeastToExtend) continue;
    if (is_boundary(piece.middle())) continue;
    const double limit = limit_of(pieces, index, end.piece, end.side);
    const double extent = extent_of(piece, end.side, limit, cloud, noise);
    moved.emplace_back(end, track_of(piece, end.side).at(extent));
  }
  for (const auto& [end, place] : moved) pieces[end.piece].ends[end.side] = place;
}

}  // namespace pcednet::lines
