#include "pcednet/lines/pieces/refine.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/half_space.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/sort_unique.h"
#include "pcednet/lines/curves/support_line.h"
#include "pcednet/lines/pieces/blunt.h"
#include "pcednet/lines/pieces/placed.h"
#include "pcednet/lines/pieces/refine_circle.h"
#include "pcednet/lines/points/moments.h"
#include "pcednet/lines/points/plane_line.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kNodesToRefine = 4;
constexpr double kPlaneSide = 0.94;        ///< least cosine of a node's side and the mean
constexpr std::size_t kTurnedByNoise = 4;  ///< a node in so many may be
constexpr double kSlightTurn = 45.0 * std::numbers::pi / 180.0;  ///< arcs up to it may be straight
/// They are if planes hold this share of the points that the arc's surfaces do, about as near.
constexpr double kAsMany = 0.95, kAsNear = 1.1;
/// Segments of this many nodes may be arcs, by the distance of nodes from the arc to that from the
/// segment, and the rise of the arc from its chord, in spacings.
constexpr std::size_t kNodesToBend = 8;
constexpr double kMuchNearer = 0.5, kLeastRise = 0.2;
constexpr double kStraightRise = 2.0 * kBoundaryTolerance;  ///< of an arc, in spacings
constexpr double kLeastSineOfSides = 0.2;  ///< of the angle between the planes of a crease

// In spacings.
constexpr double kStripInside = 1.6, kStripOutside = 1.0;
constexpr double kEmptyStrip = 1.0;  ///< beyond the last points of a strip, in squared spacings

struct Plane {
  Vec3 point, normal;
  Support support = {};
};

/// The direction into the plane from a line in it, towards `side`.
Vec3 into(const Plane& plane, const Vec3& along, const Vec3& side) {
  return turned_to(plane.normal.cross(along).normalized(), side);
}

/// The points near a segment, each once, in curve order.
std::vector<Vec3> points_near(const Piece& piece, const OrderedPoints& cloud) {
  std::vector<std::uint32_t> indices;
  std::vector<spatial::Neighbour> near;
  for (const ChainNode& node : piece.nodes) {
    cloud.within(node.at, (kSideOfSurface + 1.0) * node.spacing, near);
    for (const auto& point : near) indices.push_back(point.index);
  }
  sort_unique(indices);
  std::vector<Vec3> points;
  points.reserve(indices.size());
  for (const std::uint32_t index : indices) points.push_back(cloud.position(index));
  return points;
}

/// The mean of a side over the nodes, orthogonal to `along`; nothing if it turns at more of
/// them than `most_turned`.
std::optional<Vec3> mean_side(const Piece& piece, const Vec3& along, Vec3 ChainNode::*side,
                              std::size_t most_turned = 0) {
  Vec3 mean = Vec3::Zero();
  for (const ChainNode& node : piece.nodes) mean += node.*side;
  mean = (mean - mean.dot(along) * along).stableNormalized();
  std::size_t turned = 0;
  for (const ChainNode& node : piece.nodes) turned += (node.*side).dot(mean) < kPlaneSide ? 1 : 0;
  if (turned > most_turned) return std::nullopt;
  return mean;
}

/// A side of a segment.
struct Side {
  Vec3 into;  ///< unit
  Plane plane;

  double off(const Vec3& point) const { return std::abs((point - plane.point).dot(plane.normal)); }
};

/// The plane of the points of a side that are on it, and not rather on that of the other side.
std::optional<Plane> plane_of_side(const Piece& piece, const std::vector<Vec3>& points,
                                   const Side& side, const Side& other, const SideLimits& limits,
                                   double widened) {
  const double spacing = piece.spacing();
  PointMoments on;  // from the fit's point, in spacings
  for (const Vec3& point : points) {
    const Vec3 offset = point - piece.ends[0];
    const double away = offset.dot(side.into) / spacing, off = side.off(point);
    if (away < kFromEdge || away > kSideOfSurface) continue;
    if (off > widened * limits.tolerance * spacing) continue;
    if (offset.dot(other.into) > 0.0 && other.off(point) < off) continue;
    on.add((point - piece.fit.point) / spacing);
  }
  if (on.weight < kLeastOfSide) return std::nullopt;
  const auto [variances, axes] = eigendecomposition(on.covariance());
  if (!(variances[1] > 0.2)) return std::nullopt;
  return Plane{piece.fit.point + spacing * on.mean(),
               axes.col(0).normalized(),
               {on.weight, on.weight * variances[0]}};
}

/// The planes of both sides.
std::optional<std::array<Side, 2>> planes_of(const Piece& piece, const std::vector<Vec3>& points,
                                             const std::array<Vec3, 2>& into,
                                             const SideLimits& limits) {
  const auto first = [&](const Vec3& side) {
    return Side{side, {piece.fit.point, piece.fit.direction.cross(side)}};
  };
  std::array<Side, 2> sides = {first(into[0]), first(into[1])};
  for (int fit = 0; fit < kSideFits; ++fit) {
    const double widened = fit == 0 ? 1.5 : 1.0;
    const auto a = plane_of_side(piece, points, sides[0], sides[1], limits, widened);
    const auto b = plane_of_side(piece, points, sides[1], sides[0], limits, widened);
    if (!a || !b) return std::nullopt;
    sides[0].plane = *a, sides[1].plane = *b;
  }
  return sides;
}

/// The points beside the segment, not beyond its ends.
std::vector<Vec3> beside(const Piece& segment, const std::vector<Vec3>& points) {
  const double length = (segment.ends[1] - segment.ends[0]).norm();
  std::vector<Vec3> all;
  for (const Vec3& point : points) {
    const double place = (point - segment.ends[0]).dot(segment.fit.direction);
    if (place >= 0.0 && place <= length) all.push_back(point);
  }
  return all;
}

/// The line of a crease in place of the piece's, if it is near it.
std::optional<Placed> crease_line(const Piece& piece, const std::vector<Vec3>& near,
                                  const SideLimits& limits, std::size_t most_turned = 0) {
  const Vec3& along = piece.fit.direction;
  const auto side_a = mean_side(piece, along, &ChainNode::side_a, most_turned);
  const auto side_b = mean_side(piece, along, &ChainNode::side_b, most_turned);
  if (!side_a || !side_b) return std::nullopt;
  const std::vector<Vec3> points = beside(piece, near);
  const auto sides = planes_of(piece, points, {*side_a, *side_b}, limits);
  if (!sides) return std::nullopt;
  const Plane &a = (*sides)[0].plane, &b = (*sides)[1].plane;
  const Vec3& from = piece.fit.point;
  const auto line = line_of_planes(a.normal, (a.point - from).dot(a.normal), b.normal,
                                   (b.point - from).dot(b.normal), kLeastSineOfSides);
  if (!line) return std::nullopt;
  const Vec3 direction = turned_to(line->along, along), corner = from + line->point;
  const Vec3 into_a = into(a, direction, *side_a), into_b = into(b, direction, *side_b);
  const Vec3 up = direction.cross(into_a);
  const auto seen = [&](const Vec3& v) { return Eigen::Vector2d(v.dot(into_a), v.dot(up)); };
  std::vector<Eigen::Vector2d> places;
  for (const Vec3& point : points) places.push_back(seen(point - corner) / piece.spacing());
  const Eigen::Vector2d blunt = piece.spacing() * blunted(places, seen(into_a), seen(into_b));
  return Placed{{CurveKind::kSegment, corner + blunt.x() * into_a + blunt.y() * up, direction, 0.0,
                 piece.fit.error},
                dihedral_angle(into_a, into_b),
                a.support + b.support};
}

/// Where the strip of points along the piece ends: the side of their convex hull there, moved out
/// by what is empty beyond it on average.
std::optional<Placed> boundary_line(const Piece& piece, const std::vector<Vec3>& points) {
  const double spacing = piece.spacing();
  const Vec3& along = piece.fit.direction;
  const auto inward = mean_side(piece, along, &ChainNode::side_a);
  if (!inward) return std::nullopt;
  const Vec3 up = along.cross(*inward);
  const double length = (piece.ends[1] - piece.ends[0]).norm();
  std::vector<Eigen::Vector2d> strip;  // (along, outward)
  for (const Vec3& point : points) {
    const Vec3 offset = point - piece.ends[0];
    const double place = offset.dot(along), out = -offset.dot(*inward);
    if (place < 0.0 || place > length || std::abs(offset.dot(up)) > spacing) continue;
    if (out < -kStripInside * spacing || out > kStripOutside * spacing) continue;
    strip.emplace_back(place, out);
  }
  if (static_cast<double>(strip.size()) < kLeastOfSide) return std::nullopt;
  const std::vector<Eigen::Vector2d> hull = outer_hull(strip);
  std::size_t i = 1;
  while (i + 1 < hull.size() && hull[i].x() < 0.5 * length) ++i;
  if (hull.size() < 2 || hull[i].x() - hull[i - 1].x() < 0.25 * length) return std::nullopt;
  const double slope = (hull[i].y() - hull[i - 1].y()) / (hull[i].x() - hull[i - 1].x());
  const double beyond = kEmptyStrip * spacing * spacing / length;
  const double out = hull[i].y() + slope * (0.5 * length - hull[i].x()) + beyond;
  const Vec3 middle = 0.5 * (piece.ends[0] + piece.ends[1]);
  return Placed{{CurveKind::kSegment, middle - out * *inward,
                 (along - slope * *inward).normalized(), 0.0, piece.fit.error}};
}

/// The piece with another fit, between the places on it that are nearest to its ends.
Piece refitted(const Piece& piece, const Fit& fit) {
  Piece other = piece;
  other.fit = fit;
  for (Vec3& end : other.ends) end = nearest_on(fit, end);
  return other;
}

bool is_slight(const Piece& arc) {
  return length_of(arc) < kSlightTurn * arc.fit.radius;
}

/// A slight arc as a segment; a segment as an arc if that is much nearer to its nodes.
std::optional<Piece> in_other_kind(const Piece& piece) {
  if (piece.closed || is_boundary(piece.middle())) return std::nullopt;
  if (piece.fit.kind == CurveKind::kArc) {
    if (!is_slight(piece)) return std::nullopt;
    return refitted(piece, fit_segment(piece.nodes));
  }
  if (piece.nodes.size() < kNodesToBend) return std::nullopt;
  const Fit arc = fit_arc(piece.nodes);
  if (arc.kind != CurveKind::kArc || !(arc.error < kMuchNearer * piece.fit.error)) {
    return std::nullopt;
  }
  const double rise = (piece.ends[1] - piece.ends[0]).squaredNorm() / (8.0 * arc.radius);
  if (rise < kLeastRise * piece.spacing()) return std::nullopt;
  return refitted(piece, arc);
}

/// Whether planes explain the sides of an edge as well as surfaces of revolution do.
bool is_straight(const Placed& line, const std::optional<Placed>& circle) {
  if (!circle) return true;
  const Support &planes = line.support, &round = circle->support;
  return planes.points >= kAsMany * round.points &&
         planes.sq_distance * round.points <= kAsNear * round.sq_distance * planes.points;
}

std::optional<Placed> better_fit(const Piece& piece, const std::vector<Vec3>& points,
                                 const SideLimits& limits) {
  if (is_boundary(piece.middle())) {
    if (piece.fit.kind != CurveKind::kSegment) return std::nullopt;
    return boundary_line(piece, points);
  }
  if (piece.fit.kind == CurveKind::kSegment) return crease_line(piece, points, limits);
  return crease_circle(piece, points, limits);
}

/// Moves the piece there, unless that is far from it.
void move_to(const std::optional<Placed>& better, double shift, Piece& piece) {
  if (!better) return;
  const std::array<Vec3, 2> ends = {nearest_on(better->fit, piece.ends[0]),
                                    nearest_on(better->fit, piece.ends[1])};
  for (const std::size_t side : {0, 1}) {
    if ((ends[side] - piece.ends[side]).norm() > shift * piece.spacing()) return;
  }
  piece.fit = better->fit;
  piece.ends = ends;
  piece.dihedral = better->dihedral;
}

/// Whether a boundary, or any edge in much noise, rises so little from a chord that noise may have
/// bent it.
bool is_hardly_bent(const Piece& piece, double noise) {
  if (!is_boundary(piece.middle()) && !(noise > kMuchNoise)) return false;
  if (piece.fit.kind != CurveKind::kArc || piece.closed) return false;
  const double rise = std::pow(length_of(piece), 2) / (8.0 * piece.fit.radius);
  return is_slight(piece) && rise < kStraightRise * piece.spacing();
}

void place(Piece& piece, const OrderedPoints& cloud, const SideLimits& limits, double noise) {
  if (piece.fit.kind == CurveKind::kPolyline || piece.nodes.size() < kNodesToRefine) return;
  if (is_hardly_bent(piece, noise)) piece = refitted(piece, fit_segment(piece.nodes));
  const std::vector<Vec3> points = points_near(piece, cloud);
  const auto other = in_other_kind(piece);
  if (!other) return move_to(better_fit(piece, points, limits), limits.shift, piece);
  const bool is_segment = piece.fit.kind == CurveKind::kSegment;
  const Piece &straight = is_segment ? piece : *other, &round = is_segment ? *other : piece;
  const std::size_t by_noise = is_segment ? 0 : piece.nodes.size() / kTurnedByNoise;
  const auto line = crease_line(straight, points, limits, by_noise);
  const auto circle = crease_circle(round, points, limits);
  const bool as_segment = line ? is_straight(*line, circle) : is_segment;
  if (as_segment != is_segment) piece = *other;
  move_to(as_segment ? line : circle, limits.shift, piece);
}

}  // namespace

void refine(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
            const Progress* progress) {
  Stage stage(progress, "refine", pieces.size());
  const SideLimits limits = SideLimits::in(sampling.noise);
  parallel_blocks(pieces.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!pieces[i].exact) place(pieces[i], cloud, limits, sampling.noise);
    }
    stage.advance(end - begin);
  });
}

}  // namespace pcednet::lines
