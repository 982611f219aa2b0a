#include "pcednet/lines/refine.h"

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
#include "pcednet/lines/mean_sides.h"
#include "pcednet/lines/moments.h"
#include "pcednet/lines/plane_line.h"
#include "pcednet/lines/support_line.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kNodesToRefine = 4;
constexpr double kPlaneSide = 0.94;    ///< least cosine of a node's side and the mean
constexpr double kLeastRefined = 8.0;  ///< points
constexpr double kSlightTurn = 45.0 * std::numbers::pi / 180.0;  ///< arcs up to it may be straight
/// They are if planes hold this share of the points that the arc's surfaces do, about as near.
constexpr double kAsMany = 0.95, kAsNear = 1.1;
/// Segments of this many nodes may be arcs, by the distance of nodes from the arc to that from the
/// segment, and the rise of the arc from its chord, in spacings.
constexpr std::size_t kNodesToBend = 8;
constexpr double kMuchNearer = 0.5, kLeastRise = 0.2;
constexpr double kStraightRise = 2.0 * kBoundaryTolerance;  ///< of an arc, in spacings
constexpr int kPlaneFits = 3;
constexpr double kLeastSineOfSides = 0.2;  ///< of the angle between the planes of a crease

// In spacings.
constexpr double kSideOfPlane = 4.0;  ///< of the points that place a crease
constexpr double kFromLine = 0.3;     ///< those nearer to it may be of either side
constexpr double kMostShift = 0.8;
constexpr double kStripInside = 1.6, kStripOutside = 1.0;
constexpr double kEmptyStrip = 1.0;  ///< beyond the last points of a strip, in squared spacings

/// How a surface explains the points of a side.
struct Support {
  double points = 0.0;       ///< on it, within the tolerance
  double sq_distance = 0.0;  ///< their sum, in squared spacings
};

Support operator+(const Support& a, const Support& b) {
  return {a.points + b.points, a.sq_distance + b.sq_distance};
}

struct Plane {
  Vec3 point, normal;
  Support support = {};
};

/// Where a piece belongs, and the angle of the surfaces that meet there.
struct Placed {
  Fit fit;
  std::optional<double> dihedral = {};
  Support support = {};  ///< of both surfaces
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
    cloud.within(node.at, (kSideOfPlane + 1.0) * node.spacing, near);
    for (const auto& point : near) indices.push_back(point.index);
  }
  sort_unique(indices);
  std::vector<Vec3> points;
  points.reserve(indices.size());
  for (const std::uint32_t index : indices) points.push_back(cloud.position(index));
  return points;
}

/// The mean of a side over the nodes, orthogonal to `along`; nothing if it turns.
std::optional<Vec3> mean_side(const Piece& piece, const Vec3& along, Vec3 ChainNode::*side) {
  Vec3 mean = Vec3::Zero();
  for (const ChainNode& node : piece.nodes) mean += node.*side;
  mean = (mean - mean.dot(along) * along).stableNormalized();
  for (const ChainNode& node : piece.nodes) {
    if ((node.*side).dot(mean) < kPlaneSide) return std::nullopt;
  }
  return mean;
}

/// The plane of the points of a side, by least squares with shrinking reach.
std::optional<Plane> plane_of_side(const Piece& piece, const std::vector<Vec3>& points,
                                   const Vec3& side, double tolerance) {
  const double spacing = piece.spacing();
  const Vec3 along = piece.fit.direction;
  const double length = (piece.ends[1] - piece.ends[0]).norm();
  Plane plane{piece.fit.point, along.cross(side)};
  for (int fit = 0; fit < kPlaneFits; ++fit) {
    const double reach = (fit == 0 ? 1.5 : 1.0) * tolerance * spacing;
    PointMoments on;  // from the fit's point, in spacings
    for (const Vec3& point : points) {
      const Vec3 offset = point - piece.ends[0];
      const double place = offset.dot(along), away = offset.dot(side) / spacing;
      if (place < 0.0 || place > length || away < kFromLine || away > kSideOfPlane) continue;
      if (std::abs((point - plane.point).dot(plane.normal)) > reach) continue;
      on.add((point - piece.fit.point) / spacing);
    }
    if (on.weight < kLeastRefined) return std::nullopt;
    const auto [variances, axes] = eigendecomposition(on.covariance());
    if (!(variances[1] > 0.2)) return std::nullopt;
    plane = {piece.fit.point + spacing * on.mean(),
             axes.col(0).normalized(),
             {on.weight, on.weight * variances[0]}};
  }
  return plane;
}

/// The line of a crease in place of the piece's, if it is near it.
std::optional<Placed> crease_line(const Piece& piece, const std::vector<Vec3>& points,
                                  double tolerance) {
  const Vec3& along = piece.fit.direction;
  const auto side_a = mean_side(piece, along, &ChainNode::side_a);
  const auto side_b = mean_side(piece, along, &ChainNode::side_b);
  if (!side_a || !side_b) return std::nullopt;
  const auto a = plane_of_side(piece, points, *side_a, tolerance);
  const auto b = plane_of_side(piece, points, *side_b, tolerance);
  if (!a || !b) return std::nullopt;
  const Vec3& from = piece.fit.point;
  const auto line = line_of_planes(a->normal, (a->point - from).dot(a->normal), b->normal,
                                   (b->point - from).dot(b->normal), kLeastSineOfSides);
  if (!line) return std::nullopt;
  const Vec3 direction = turned_to(line->along, along);
  return Placed{{CurveKind::kSegment, from + line->point, direction, 0.0, piece.fit.error},
                dihedral_angle(into(*a, direction, *side_a), into(*b, direction, *side_b)),
                a->support + b->support};
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
  if (static_cast<double>(strip.size()) < kLeastRefined) return std::nullopt;
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

/// A side of an arc in its half-plane (outward from the axis, along the axis).
struct Ray {
  Eigen::Vector2d point, direction;
  Support support = {};
};

/// Whether the place is beside the arc, not beyond its ends.
bool is_beside(const Piece& piece, const Vec3& place) {
  if (piece.closed) return true;
  const auto angle = [&](const Vec3& to) {
    return turn_about(piece.fit.direction, piece.ends[0] - piece.fit.point, to - piece.fit.point);
  };
  return angle(place) <= angle(piece.ends[1]);
}

std::optional<Ray> ray_of_side(const Piece& piece, const std::vector<Eigen::Vector2d>& points,
                               const Eigen::Vector2d& side, double tolerance) {
  const double spacing = piece.spacing();
  Ray ray{Eigen::Vector2d::Zero(), side};
  for (int fit = 0; fit < kPlaneFits; ++fit) {
    const double reach = (fit == 0 ? 1.5 : 1.0) * tolerance * spacing;
    const Eigen::Vector2d normal(-ray.direction.y(), ray.direction.x());
    FlatMoments on;
    for (const Eigen::Vector2d& point : points) {
      const double away = point.dot(side) / spacing;
      if (away < kFromLine || away > kSideOfPlane) continue;
      if (std::abs((point - ray.point).dot(normal)) > reach) continue;
      on.add(point);
    }
    if (on.count < kLeastRefined) return std::nullopt;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(on.covariance() / (spacing * spacing));
    if (!(solver.eigenvalues()[1] > 0.2)) return std::nullopt;
    const Eigen::Vector2d direction = solver.eigenvectors().col(1);
    ray = {on.mean(),
           direction.dot(side) < 0.0 ? Eigen::Vector2d(-direction) : direction,
           {on.count, on.count * solver.eigenvalues()[0]}};
  }
  return ray;
}

/// The mean of each side over the nodes in the half-plane.
std::optional<Sides> sides_about_axis(const Piece& piece) {
  std::vector<Sides> sides;
  for (const ChainNode& node : piece.nodes) {
    const Vec3 tangent = tangent_at(piece.fit, node.at);
    const Vec3 outward = tangent.cross(piece.fit.direction);
    const auto turned = [&](const Vec3& side) {
      return Eigen::Vector2d(side.dot(outward), side.dot(piece.fit.direction));
    };
    sides.push_back({turned(node.side_a), turned(node.side_b)});
  }
  return mean_sides(sides, 0.8);
}

/// The circle in which the two surfaces of revolution about the piece's axis meet.
std::optional<Placed> crease_circle(const Piece& piece, const std::vector<Vec3>& points,
                                    double tolerance) {
  const auto sides = sides_about_axis(piece);
  if (!sides) return std::nullopt;
  std::vector<Eigen::Vector2d> flat;
  for (const Vec3& point : points) {
    if (is_beside(piece, point))
      flat.push_back(about_axis(piece.fit, point) - Eigen::Vector2d(piece.fit.radius, 0.0));
  }
  const auto a = ray_of_side(piece, flat, (*sides)[0], tolerance);
  const auto b = ray_of_side(piece, flat, (*sides)[1], tolerance);
  if (!a || !b) return std::nullopt;
  const double cross = a->direction.x() * b->direction.y() - a->direction.y() * b->direction.x();
  if (std::abs(cross) < 0.3) return std::nullopt;
  const Eigen::Vector2d between = b->point - a->point;
  const double t = (between.x() * b->direction.y() - between.y() * b->direction.x()) / cross;
  const Eigen::Vector2d meet = a->point + t * a->direction;
  Fit fit = piece.fit;
  fit.radius += meet.x();
  fit.point += meet.y() * fit.direction;
  if (!(fit.radius > 0.0)) return std::nullopt;
  const auto in_space = [](const Eigen::Vector2d& v) { return Vec3(v.x(), v.y(), 0.0); };
  return Placed{fit, dihedral_angle(in_space(a->direction), in_space(b->direction)),
                a->support + b->support};
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
                                 double tolerance) {
  if (is_boundary(piece.middle())) {
    if (piece.fit.kind != CurveKind::kSegment) return std::nullopt;
    return boundary_line(piece, points);
  }
  if (piece.fit.kind == CurveKind::kSegment) return crease_line(piece, points, tolerance);
  return crease_circle(piece, points, tolerance);
}

/// Moves the piece there, unless that is far from it.
void move_to(const std::optional<Placed>& better, Piece& piece) {
  if (!better) return;
  const std::array<Vec3, 2> ends = {nearest_on(better->fit, piece.ends[0]),
                                    nearest_on(better->fit, piece.ends[1])};
  for (const std::size_t side : {0, 1}) {
    if ((ends[side] - piece.ends[side]).norm() > kMostShift * piece.spacing()) return;
  }
  piece.fit = better->fit;
  piece.ends = ends;
  piece.dihedral = better->dihedral;
}

/// Whether a boundary rises so little from a chord that noise may have bent it.
bool is_hardly_bent(const Piece& piece) {
  if (!is_boundary(piece.middle()) || piece.fit.kind != CurveKind::kArc || piece.closed)
    return false;
  const double rise = std::pow(length_of(piece), 2) / (8.0 * piece.fit.radius);
  return is_slight(piece) && rise < kStraightRise * piece.spacing();
}

void place(Piece& piece, const OrderedPoints& cloud, double tolerance) {
  if (piece.fit.kind == CurveKind::kPolyline || piece.nodes.size() < kNodesToRefine) return;
  if (is_hardly_bent(piece)) piece = refitted(piece, fit_segment(piece.nodes));
  const std::vector<Vec3> points = points_near(piece, cloud);
  const auto other = in_other_kind(piece);
  if (!other) return move_to(better_fit(piece, points, tolerance), piece);
  const bool is_segment = piece.fit.kind == CurveKind::kSegment;
  const Piece &straight = is_segment ? piece : *other, &round = is_segment ? *other : piece;
  const auto line = crease_line(straight, points, tolerance);
  const auto circle = crease_circle(round, points, tolerance);
  const bool as_segment = line ? is_straight(*line, circle) : is_segment;
  if (as_segment != is_segment) piece = *other;
  move_to(as_segment ? line : circle, piece);
}

}  // namespace

void refine(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
            const Progress* progress) {
  Stage stage(progress, "refine", pieces.size());
  const double tolerance = 0.3 + 1.2 * sampling.noise;
  parallel_blocks(pieces.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!pieces[i].exact) place(pieces[i], cloud, tolerance);
    }
    stage.advance(end - begin);
  });
}

}  // namespace pcednet::lines
