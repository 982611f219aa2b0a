#include "pcednet/lines/pieces/finish.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "pcednet/lines/pieces/corners.h"
#include "pcednet/lines/pieces/regularise.h"
#include "pcednet/lines/pieces/strings.h"
#include "pcednet/lines/points/sampling.h"

namespace pcednet::lines {
namespace {

// The length of a piece that no corner holds, and of one that ends free, in spacings; the second
// number is added per spacing of noise. An end at the inside of a piece is free unless exact.
constexpr double kLoose[] = {8.0, 4.0}, kHeldOnce[] = {5.0, 1.0};
constexpr double kExactLoose = 8.0, kExactHeldOnce = 4.0;
constexpr double kExactFree = 2.5;  ///< where exact planes meet
constexpr int kDropRounds = 9;      ///< those that hung on a dropped piece are loose now

constexpr double kExactReach = 5.0, kExactTolerance = 0.6;  ///< of corners of exact pieces

/// Edge points per spacing: shorter pieces with fewer are kept only if corners hold both ends.
constexpr double kFewEdgePoints = 0.1, kLongAnyway = 15.0;

/// Beyond kLittleNoise all pieces need edge points: kPointsForNoise more per spacing of noise.
constexpr double kLittleNoise = 0.1, kPointsForNoise = 1.5;

/// In much noise, pieces of which corners hold no end, or one, need edge points as probable as
/// this.
constexpr double kLeastProbable[] = {0.95, 0.68};

/// A row of kLongRow spacings or more, with kDenseRow edge points in each, may be less probable.
constexpr double kLongRow = 16.0, kDenseRow = 0.9, kProbableRow = 0.65;

constexpr double kMostly = 0.5;  ///< of the creases

/// Surfaces that bend by more are rounded at the edge unless as many of its points are sharp-edge.
constexpr double kBend = 0.08, kFewSharp = 0.1;
constexpr double kStrongBend = 0.16, kSomeSharp = 0.3;

double mean_of(const Piece& piece, double ChainNode::*value) {
  double sum = 0.0;
  for (const ChainNode& node : piece.nodes) sum += node.*value;
  return sum / static_cast<double>(piece.nodes.size());
}

double mean_dihedral(const Piece& piece) {
  if (piece.dihedral) return *piece.dihedral;
  double sum = 0.0;
  for (const ChainNode& node : piece.nodes) {
    sum += dihedral_angle(node.side_a, node.side_b);
  }
  return sum / static_cast<double>(piece.nodes.size());
}

/// The edge points that a piece hangs on.
struct EdgePointsOfPiece {
  double count;
  double probability;  ///< mean
};

EdgePointsOfPiece edge_points_of(const Piece& piece) {
  double count = 0.0, probability = 0.0;
  for (const ChainNode& node : piece.nodes) {
    count += node.edge_points;
    probability += node.edge_points * node.probability;
  }
  return {count, count > 0.0 ? probability / count : 0.0};
}

/// The circle about this centre and the axis of the fit through `place`.
void set_circle(Curve& curve, const Fit& fit, const Vec3& centre, const Vec3& place) {
  curve.kind = CurveKind::kCircle;
  curve.closed = true;
  curve.centre = centre;
  curve.axis = fit.direction;
  curve.points = {place};
  curve.radius = (place - centre).norm();
}

/// The arc through both ends whose centre is the nearest to that of the fit; if both ends are one
/// place, the circle through it.
void set_arc(Curve& curve, const Fit& fit) {
  if (curve.points.front() == curve.points.back()) {
    const Vec3 place = curve.points.front();
    const double height = (place - fit.point).dot(fit.direction);
    return set_circle(curve, fit, fit.point + height * fit.direction, place);
  }
  const Vec3 &from = curve.points.front(), &to = curve.points.back();
  const Vec3 chord = (to - from).normalized(), middle = 0.5 * (from + to);
  curve.axis = (fit.direction - fit.direction.dot(chord) * chord).normalized();
  const Vec3 across = curve.axis.cross(chord);
  curve.centre = middle + (fit.point - middle).dot(across) * across;
  curve.radius = (from - curve.centre).norm();
}

void set_shape(Curve& curve, const Piece& piece, const std::array<Vec3, 2>& ends,
               double tolerance) {
  curve.kind = piece.fit.kind;
  curve.closed = piece.closed;
  if (curve.kind == CurveKind::kPolyline) {
    for (const ChainNode& node : piece.nodes) curve.points.push_back(node.at);
    if (!piece.closed) {
      curve.points.front() = ends[0];
      curve.points.back() = ends[1];
    }
    curve.points = simplified(curve.points, 0.5 * tolerance * piece.spacing());
  } else if (piece.closed) {
    set_circle(curve, piece.fit, piece.fit.point, nearest_on(piece.fit, piece.nodes.front().at));
  } else {
    curve.points = {ends[0], ends[1]};
    if (curve.kind == CurveKind::kArc) set_arc(curve, piece.fit);
  }
}

Curve curve_between(const Piece& piece, const std::array<Vec3, 2>& ends,
                    const FinishOptions& options) {
  Curve curve{.edge_class = class_of(piece, options.noise)};
  curve.exact = piece.exact;
  set_shape(curve, piece, ends, options.tolerance);
  curve.dihedral_angle = mean_dihedral(piece);
  const EdgePointsOfPiece on_edge = edge_points_of(piece);
  curve.support = static_cast<std::size_t>(std::lround(on_edge.count));
  curve.confidence =
      on_edge.count > 0.0 ? on_edge.probability : mean_of(piece, &ChainNode::probability);
  return curve;
}

/// What edge points say for a piece: how many there are per spacing, and their mean probability.
struct Evidence {
  double per_spacing, probability;
};

Evidence evidence_of(const Piece& piece) {
  const EdgePointsOfPiece on_edge = edge_points_of(piece);
  return {on_edge.count * piece.spacing() / length_of(piece), on_edge.probability};
}

/// Whether the points that the piece hangs on are nearly all of no edge class.
bool has_few_edge_points(const Piece& piece, const Evidence& evidence, double noise, bool held) {
  const double found = evidence.per_spacing;
  if (found < kPointsForNoise * (noise - kLittleNoise)) return true;
  return !held && found < kFewEdgePoints && length_of(piece) < kLongAnyway * piece.spacing();
}

/// The kind of the piece; of a polyline that a tolerance below the noise left, what the noise lets
/// it be.
CurveKind kind_in_noise(const Piece& piece, double noise) {
  if (piece.fit.kind != CurveKind::kPolyline) return piece.fit.kind;
  const double within = usual_tolerance(noise);
  if (fit_segment(piece.nodes).error <= within) return CurveKind::kSegment;
  const Fit arc = fit_arc(piece.nodes);
  return arc.error <= within ? arc.kind : CurveKind::kPolyline;
}

/// Whether the piece is straight, or an arc that a corner holds, and has a row of edge points too
/// long for chance.
bool is_long_row(const Piece& piece, const Evidence& evidence, double noise, std::ptrdiff_t held) {
  const CurveKind kind = kind_in_noise(piece, noise);
  return (kind == CurveKind::kSegment || (kind == CurveKind::kArc && held > 0)) &&
         length_of(piece) >= kLongRow * piece.spacing() && evidence.per_spacing >= kDenseRow;
}

/// Whether the piece ends free, in noise, and hangs on points that are edges only perhaps.
bool is_doubtful(const Piece& piece, const Evidence& evidence, double noise, std::ptrdiff_t held) {
  if (!(noise > kMuchNoise) || held == 2) return false;
  const bool row = is_long_row(piece, evidence, noise, held);
  return evidence.probability < (row ? kProbableRow : kLeastProbable[held]);
}

/// The least length of a piece of which corners hold `held` ends, in spacings.
double least_length(std::ptrdiff_t held, const FinishOptions& options) {
  if (held == 2) return 0.0;
  if (options.exact) return held == 0 ? kExactLoose : kExactHeldOnce;
  const double* least = held == 0 ? kLoose : kHeldOnce;
  return least[0] + least[1] * options.noise;
}

bool is_of_boundary(const Piece& piece) {
  return mean_of(piece, &ChainNode::boundary) > 0.5;
}

/// How many pieces, those of boundaries left out or not, end in each corner.
std::vector<std::size_t> ends_in(const Corners& corners, std::span<const Piece> pieces,
                                 bool with_boundaries) {
  std::vector<std::size_t> ends(corners.places.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!with_boundaries && is_of_boundary(pieces[i])) continue;
    for (const std::size_t corner : corners.of_ends[i]) {
      if (corner != Corners::kNoCorner) ++ends[corner];
    }
  }
  return ends;
}

/// True if a piece was dropped.
bool drop_loose(std::vector<Piece>& pieces, const Corners& corners, const FinishOptions& options) {
  const std::vector<std::size_t> all_end = ends_in(corners, pieces, true);
  // A boundary beside it makes no edge: where plants are scanned, every edge ends near one. Exact
  // pieces are of roofs, where eaves do.
  const std::vector<std::size_t> edges_end = ends_in(corners, pieces, options.exact);
  const std::size_t to_hold = options.exact ? 1 : 2;
  std::size_t i = 0;
  return std::erase_if(pieces, [&](const Piece& piece) {
           const auto& own = corners.of_ends[i++];
           if (piece.closed) return false;
           const std::vector<std::size_t>& ends = is_of_boundary(piece) ? all_end : edges_end;
           const auto held = std::count_if(own.begin(), own.end(), [&](std::size_t corner) {
             return corner != Corners::kNoCorner && ends[corner] >= to_hold;
           });
           if (piece.exact) return held == 0 && length_of(piece) < kExactFree * piece.spacing();
           if (!options.exact) {
             const Evidence evidence = evidence_of(piece);
             if (has_few_edge_points(piece, evidence, options.noise, held == 2)) return true;
             if (is_doubtful(piece, evidence, options.noise, held)) return true;
           }
           return length_of(piece) < least_length(held, options) * piece.spacing();
         }) > 0;
}

bool is_sound(const Curve& curve) {
  const bool round = curve.kind == CurveKind::kArc || curve.kind == CurveKind::kCircle;
  return std::all_of(curve.points.begin(), curve.points.end(),
                     [](const Vec3& p) { return p.allFinite(); }) &&
         (!round || (curve.radius > 0.0 && curve.centre.allFinite() && curve.axis.allFinite() &&
                     curve.axis.norm() > 0.5));
}

}  // namespace

EdgeClass class_of(const Piece& piece, double noise) {
  if (is_of_boundary(piece)) return kBoundary;
  if (piece.rounded || mean_of(piece, &ChainNode::rounded) > kMostly) return kSmoothEdge;
  const double bend = mean_of(piece, &ChainNode::bend) - noise;
  const double sharp = mean_of(piece, &ChainNode::sharp);
  const bool rounded =
      (bend > kBend && sharp < kFewSharp) || (bend > kStrongBend && sharp < kSomeSharp);
  return rounded ? kSmoothEdge : kSharpEdge;
}

Curve curve_of(const Piece& piece, const FinishOptions& options) {
  return curve_between(piece, piece.ends, options);
}

std::vector<Curve> finish(std::vector<Piece> pieces, const FinishOptions& options) {
  const auto meet = [&] {
    return options.exact ? find_corners(pieces, kExactReach, kExactTolerance)
                         : find_corners(pieces, options.noise);
  };
  Corners corners = meet();
  for (int round = 0; round < kDropRounds && drop_loose(pieces, corners, options); ++round) {
    corners = meet();
  }
  hold_directions(pieces, corners);
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::array<Vec3, 2> ends = pieces[i].ends;
    for (const std::size_t side : {0, 1}) {
      const std::size_t corner = corners.of_ends[i][side];
      if (corner != Corners::kNoCorner) ends[side] = corners.places[corner];
    }
    Curve curve = curve_between(pieces[i], ends, options);
    if (is_sound(curve)) curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace pcednet::lines
