#include <algorithm>
#include <cmath>
#include <numbers>

#include "workbench/shapes/curve_fit.h"
#include "workbench/shapes/true_curves.h"

namespace pcednet::shapes {
namespace {

using lines::Curve;
using lines::CurveKind;

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

std::vector<Curve> true_curves(std::span<const EdgeCurve> edges) {
  return Chains(edges).take();
}

}  // namespace pcednet::shapes
