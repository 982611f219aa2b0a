#include "workbench/shapes/true_curves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/solids/edge_walk.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {
namespace {

using lines::Curve;
using lines::CurveKind;

/// The largest distance of a true point from its curve.
constexpr double kExactFit = 1e-6;

/// Radius over chord of arcs at most: a flatter curve is only by chance as near to a circle.
constexpr double kFlattest = 100.0;

std::optional<Curve> as_segment(std::span<const Vec3> points) {
  const Segment segment = {points.front(), points.back()};
  for (const Vec3& p : points) {
    if (distance(segment, p) > kExactFit) return std::nullopt;
  }
  Curve curve;
  curve.kind = CurveKind::kSegment;
  curve.points = {segment.a, segment.b};
  return curve;
}

/// The circle through three of the points, if all are on it.
std::optional<Curve> as_arc(std::span<const Vec3> points, bool closed) {
  const std::size_t n = points.size();
  if (n < 3) return std::nullopt;
  const Vec3& a = points[0];
  const Vec3 u = points[closed ? n / 3 : n / 2] - a, v = points[closed ? 2 * n / 3 : n - 1] - a;
  const Vec3 normal = u.cross(v);
  if (!(normal.norm() > 0.0)) return std::nullopt;
  Curve curve;
  curve.kind = closed ? CurveKind::kCircle : CurveKind::kArc;
  curve.closed = closed;
  const Vec3 to_centre =
      (u.squaredNorm() * v - v.squaredNorm() * u).cross(normal) / (2.0 * normal.squaredNorm());
  curve.centre = a + to_centre;
  curve.axis = normal.normalized();
  curve.radius = to_centre.norm();
  if (!(curve.radius < kFlattest * (points[n - 1] - a).norm()) && !closed) return std::nullopt;
  for (const Vec3& p : points) {
    const Vec3 offset = p - curve.centre;
    const double height = offset.dot(curve.axis);
    const double away = (offset - height * curve.axis).norm() - curve.radius;
    if (!(std::hypot(height, away) < kExactFit)) return std::nullopt;
  }
  curve.points = {a};
  if (!closed) curve.points.push_back(points.back());
  return curve;
}

/// The segment, arc or circle that all points (two or more, in order) lie on, if there is one.
std::optional<Curve> fit_exact(std::span<const Vec3> points, bool closed) {
  if (!closed) {
    if (auto curve = as_segment(points)) return curve;
  }
  return as_arc(points, closed);
}

/// Adds points between `from` and `to` until the chords are exact.
void add_between(const EdgeWalk& walk, const WalkedEdge& edge, const Vec3& from, const Vec3& to,
                 std::vector<Vec3>& points) {
  constexpr double kShortest = 1e-4;
  const Vec3 middle = 0.5 * (from + to);
  const auto exact = walk.onto_edge(edge, middle);
  if (!exact || (to - from).norm() < kShortest) return;
  const double away = (*exact - middle).norm();
  if (away < kExactFit || away > 0.1 * (to - from).norm()) return;
  add_between(walk, edge, from, *exact, points);
  points.push_back(*exact);
  add_between(walk, edge, *exact, to, points);
}

Curve as_polyline(const EdgeWalk& walk, const WalkedEdge& edge) {
  Curve curve;
  curve.closed = edge.closed;
  for (std::size_t i = 0; i < edge.points.size(); ++i) {
    curve.points.push_back(edge.points[i]);
    if (i + 1 < edge.points.size() || edge.closed) {
      add_between(walk, edge, edge.points[i], edge.points[(i + 1) % edge.points.size()],
                  curve.points);
    }
  }
  return curve;
}

constexpr double kSamePlace = 1e-7;

/// An edge as points on it, and where its ends are.
struct Link {
  std::vector<Vec3> points;
  EdgeClass edge_class;
  const Arc* arc;  ///< null for a segment
  std::size_t from = 0, to = 0;
  bool used = false;
};

bool is_full(const Arc& arc) {
  return arc.angle > 2.0 * std::numbers::pi - 1e-9;
}

Vec3 point_at(const Arc& arc, double t) {
  return arc.centre + arc.radius * (std::cos(t) * arc.x + std::sin(t) * arc.y);
}

Link link_of(const EdgeCurve& edge) {
  if (const auto* segment = std::get_if<Segment>(&edge.curve)) {
    return {{segment->a, segment->b}, edge.strength, nullptr};
  }
  constexpr int kPieces = 32;
  const Arc& arc = std::get<Arc>(edge.curve);
  Link link = {{}, edge.strength, &arc};
  for (int i = 0; i <= kPieces; ++i) link.points.push_back(point_at(arc, arc.angle * i / kPieces));
  if (is_full(arc)) link.points.pop_back();
  return link;
}

/// The links in a row that make one curve.
class Chains {
 public:
  explicit Chains(std::span<const EdgeCurve> edges) {
    for (const EdgeCurve& edge : edges) {
      Link link = link_of(edge);
      link.from = place_of(link.points.front());
      link.to = place_of(link.points.back());
      if (link.arc && is_full(*link.arc)) {
        link.used = true;
        curves_.push_back(fitted(link.points, true, link.edge_class));
      }
      ends_[link.from].push_back(links_.size());
      ends_[link.to].push_back(links_.size());
      links_.push_back(std::move(link));
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (!links_[i].used) gather(i);
    }
  }

  std::vector<Curve> take() { return std::move(curves_); }

 private:
  std::size_t place_of(const Vec3& p) {
    const auto same = std::find_if(places_.begin(), places_.end(), [&](const Vec3& place) {
      return (place - p).norm() < kSamePlace;
    });
    if (same != places_.end()) return static_cast<std::size_t>(same - places_.begin());
    places_.push_back(p);
    ends_.emplace_back();
    return places_.size() - 1;
  }

  static Curve fitted(const std::vector<Vec3>& points, bool closed, EdgeClass edge_class) {
    Curve curve = fit_exact(points, closed).value_or(Curve{.points = points, .closed = closed});
    curve.edge_class = edge_class;
    curve.confidence = 1.0;
    return curve;
  }

  /// One link continues the other: both of one circle, or chords that hardly turn.
  static bool continues(const Link& link, const Link& next, const Vec3& way, const Vec3& on) {
    if (link.edge_class != next.edge_class || !link.arc != !next.arc) return false;
    if (way.dot(on) < std::cos(15.0 / 180.0 * std::numbers::pi)) return false;
    return !link.arc || ((link.arc->centre - next.arc->centre).norm() < kSamePlace &&
                         std::abs(link.arc->radius - next.arc->radius) < kSamePlace);
  }

  void gather(std::size_t first) {
    links_[first].used = true;
    std::vector<Vec3> points = links_[first].points;
    extend(points, first, links_[first].to);
    std::reverse(points.begin(), points.end());
    const bool closed = points.size() > 3 && points.front() == points.back();
    if (closed) {
      points.pop_back();
    } else {
      extend(points, first, links_[first].from);
    }
    curves_.push_back(fitted(points, closed, links_[first].edge_class));
  }

  /// Adds the points of the links that continue `link` beyond its end at `place`.
  void extend(std::vector<Vec3>& points, std::size_t link, std::size_t place) {
    while (ends_[place].size() == 2) {
      const std::size_t other = ends_[place][0] == link ? ends_[place][1] : ends_[place][0];
      Link& next = links_[other];
      if (next.used) {
        if (next.from == place || next.to == place) points.back() = places_[place];
        return;
      }
      std::vector<Vec3> added = next.points;
      if (next.to == place) std::reverse(added.begin(), added.end());
      const Vec3 way = (points.back() - points[points.size() - 2]).normalized();
      if (!continues(links_[link], next, way, (added[1] - added[0]).normalized())) return;
      next.used = true;
      points.insert(points.end(), added.begin() + 1, added.end());
      place = next.to == place ? next.from : next.to;
      points.back() = places_[place];
      link = other;
    }
  }

  std::vector<Link> links_;
  std::vector<Vec3> places_;
  std::vector<std::vector<std::size_t>> ends_;  ///< the links at each place
  std::vector<Curve> curves_;
};

}  // namespace

std::vector<Curve> true_curves(const Solid& solid, std::span<const BorderPoint> borders) {
  const EdgeWalk walk(solid, borders);
  std::vector<Curve> curves;
  std::vector<Vec3> corners;
  for (WalkedEdge edge : walk.edges()) {
    if (!edge.closed) {
      for (Vec3* end : {&edge.points.front(), &edge.points.back()}) {
        const auto same = std::find_if(corners.begin(), corners.end(), [&](const Vec3& corner) {
          return (corner - *end).norm() < kExactFit;
        });
        if (same == corners.end())
          corners.push_back(*end);
        else
          *end = *same;
      }
    }
    if (!edge.closed && edge.points.front() == edge.points.back()) {
      edge.closed = true;
      edge.points.pop_back();
    }
    auto curve = fit_exact(edge.points, edge.closed);
    if (!curve) curve = as_polyline(walk, edge);
    curve->confidence = 1.0;
    curve->dihedral_angle = edge.turn;
    curves.push_back(*std::move(curve));
  }
  return curves;
}

std::vector<Curve> rotated(std::vector<Curve> curves, const Mat3& rotation) {
  for (Curve& curve : curves) {
    for (Vec3& p : curve.points) p = rotation * p;
    curve.centre = rotation * curve.centre;
    curve.axis = rotation * curve.axis;
  }
  return curves;
}

void drop_unseen(std::vector<lines::Curve>& curves, std::span<const Vec3> positions, double reach) {
  const spatial::KdTree tree(positions);
  std::vector<spatial::Neighbour> near;
  std::erase_if(curves, [&](const lines::Curve& curve) {
    std::size_t seen = 0, all = 0;
    const std::vector<Vec3> vertices = lines::sampled(curve, 0.1 * reach);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const Vec3 along = vertices[i] - vertices[i - 1];
      const int pieces = static_cast<int>(std::ceil(along.norm() / (0.5 * reach)));
      for (int k = 0; k < pieces; ++k, ++all) {
        tree.nearest(vertices[i - 1] + (k + 0.5) / pieces * along, 1, near);
        seen += !near.empty() && near.front().sq_distance < reach * reach;
      }
    }
    return 2 * seen < all;
  });
}

std::vector<Curve> true_curves(std::span<const EdgeCurve> edges) {
  std::vector<Curve> curves = Chains(edges).take();
  std::erase_if(curves, [](const Curve& curve) { return lines::length_of(curve) == 0.0; });
  return curves;
}

}  // namespace pcednet::shapes
