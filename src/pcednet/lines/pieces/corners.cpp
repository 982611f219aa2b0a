#include "pcednet/lines/pieces/corners.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "pcednet/core/parallel.h"
#include "pcednet/lines/curves/touch.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kEndsAtOnce = 64;
constexpr int kMeetSteps = 6;
constexpr double kCornerReach = 9.0, kCornerTolerance = 0.8;
constexpr double kExactAside = 0.3;  ///< spacings of a corner from an exact line
constexpr double kLeastWeight = 4.0, kMostWeight = 20.0;  ///< of a curve in its corner
constexpr double kExactWeight = 100.0;                    ///< the same of an exact one
constexpr double kTouch = 0.5;                            ///< spacings between curves that touch
constexpr double kPull = 1e-3;   ///< towards the ends, where curves are parallel
constexpr double kOneEnd = 2.0;  ///< spacings between both ends of a line that may be one
constexpr double kLeastClosing =
    1.2 * std::numbers::pi;  ///< radians of an arc whose ends may be one

/// How well the points determine the place of a curve: by their number, within limits.
double weight_of(const Piece& piece) {
  if (piece.exact) return kExactWeight;
  if (piece.fit.kind == CurveKind::kPolyline) return kLeastWeight;
  return std::clamp(static_cast<double>(piece.nodes.size()), kLeastWeight, kMostWeight);
}

/// Whether both ends may be one: the arc at the end of a slot is half a circle.
bool may_close(const Piece& piece) {
  if (piece.fit.kind != CurveKind::kArc) return true;
  return length_of(piece) > kLeastClosing * piece.fit.radius;
}

class Meeting {
 public:
  Meeting(const std::vector<Piece>& pieces, double reach, double tolerance)
      : pieces_(pieces), reach_(reach), tolerance_(tolerance), ends_(open_ends(pieces)) {
    for (std::size_t e = 0; e < ends_.size(); ++e) {
      group_.push_back(e);
      members_.push_back({e});
    }
  }

  Corners solve();

 private:
  struct Candidate {
    std::size_t a, b;
    double cost;
  };

  const Piece& piece_of(std::size_t end) const { return pieces_[ends_[end].piece]; }
  const Vec3& place_of(std::size_t end) const { return piece_of(end).ends[ends_[end].side]; }
  Vec3 outward(std::size_t end) const { return lines::outward(piece_of(end), ends_[end].side); }
  Vec3 nearest(std::size_t end, const Vec3& place) const {
    const Piece& piece = piece_of(end);
    if (piece.fit.kind != CurveKind::kPolyline) return nearest_on(piece.fit, place);
    const Vec3 along = outward(end);
    return place_of(end) + (place - place_of(end)).dot(along) * along;
  }
  Vec3 meet(const std::vector<std::size_t>& ends) const;
  double cost_at(const std::vector<std::size_t>& ends, const Vec3& place) const;
  bool closes_a_piece(const std::vector<std::size_t>& ends) const;
  std::vector<Candidate> candidates() const;
  std::optional<Vec3> place_inside(std::size_t end, const NodeIndex& index) const;
  void to_insides(Corners& corners) const;

  const std::vector<Piece>& pieces_;
  double reach_, tolerance_;
  std::vector<End> ends_;
  std::vector<std::size_t> group_;                 ///< of each end: one of its ends
  std::vector<std::vector<std::size_t>> members_;  ///< of each group
};

/// The place nearest to all their curves, by least squares.
Vec3 Meeting::meet(const std::vector<std::size_t>& ends) const {
  Vec3 centre = Vec3::Zero();
  for (const std::size_t end : ends) centre += place_of(end) / static_cast<double>(ends.size());
  if (ends.size() == 2) {
    const Piece &a = piece_of(ends[0]), &b = piece_of(ends[1]);
    if (const auto touch = touching_place(a.fit, b.fit, centre, kTouch * a.spacing()))
      return *touch;
  }
  Vec3 place = centre;
  for (int step = 0; step < kMeetSteps; ++step) {
    Mat3 left = kPull * Mat3::Identity();
    Vec3 right = kPull * (centre - place);
    for (const std::size_t end : ends) {
      const Vec3 on = nearest(end, place);
      const Piece& piece = piece_of(end);
      const Vec3 along =
          piece.fit.kind == CurveKind::kPolyline ? outward(end) : tangent_at(piece.fit, on);
      const Mat3 across = Mat3::Identity() - along * along.transpose();
      const double weight = weight_of(piece);
      left += weight * across;
      right += weight * across * (on - place);
    }
    place += left.ldlt().solve(right);
  }
  return place;
}

/// How far ends are moved, in spacings; infinite if a curve misses the place or would be changed
/// too much.
double Meeting::cost_at(const std::vector<std::size_t>& ends, const Vec3& place) const {
  double cost = 0.0;
  for (const std::size_t end : ends) {
    const double spacing = piece_of(end).spacing();
    const double aside = (nearest(end, place) - place).norm() / spacing;
    const Vec3 offset = place - place_of(end);
    const double ahead = offset.dot(outward(end)) / spacing;
    const double length = length_of(piece_of(end)) / spacing;
    if (!(aside < (piece_of(end).exact ? kExactAside : tolerance_)) ||
        offset.norm() > reach_ * spacing) {
      return std::numeric_limits<double>::infinity();
    }
    if (ahead < -std::min(3.5, 0.5 * length)) return std::numeric_limits<double>::infinity();
    cost += std::abs(ahead) + 2.0 * aside;
  }
  return cost;
}

/// Whether both ends of one piece are among these that is not nearly a circle.
bool Meeting::closes_a_piece(const std::vector<std::size_t>& ends) const {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      if (ends_[ends[i]].piece == ends_[ends[j]].piece && !may_close(piece_of(ends[i])))
        return true;
    }
  }
  return false;
}

std::vector<Meeting::Candidate> Meeting::candidates() const {
  std::vector<Vec3> places;
  for (std::size_t e = 0; e < ends_.size(); ++e) places.push_back(place_of(e));
  const spatial::KdTree tree(places);
  std::vector<std::vector<Candidate>> of_ends(ends_.size());
  parallel_blocks(ends_.size(), kEndsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t a = begin; a < end; ++a) {
      tree.within(places[a], 1.5 * reach_ * piece_of(a).spacing(), near);
      for (const auto& other : near) {
        const std::size_t b = other.index;
        if (b <= a || ends_[a].piece == ends_[b].piece) continue;
        const std::vector<std::size_t> both = {a, b};
        const double cost = cost_at(both, meet(both));
        if (std::isfinite(cost)) of_ends[a].push_back({a, b, cost});
      }
    }
  });
  std::vector<Candidate> found;
  for (const auto& of_end : of_ends) found.insert(found.end(), of_end.begin(), of_end.end());
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return found;
}

/// The place inside another piece where an end would meet it.
std::optional<Vec3> Meeting::place_inside(std::size_t end, const NodeIndex& index) const {
  const Piece& piece = piece_of(end);
  const double spacing = piece.spacing();
  const Vec3 t = outward(end);
  std::vector<spatial::Neighbour> near;
  index.tree.within(place_of(end), reach_ * spacing, near);
  for (const auto& other : near) {
    const Piece& target = pieces_[index.piece[other.index]];
    if (&target == &piece || target.fit.kind == CurveKind::kPolyline) continue;
    // Where the end's tangent passes the target nearest.
    const Vec3& beside = index.nodes[other.index]->at;
    Vec3 place = beside;
    for (int step = 0; step < 20; ++step) place = nearest(end, nearest_on(target.fit, place));
    const Vec3 on = nearest_on(target.fit, place);
    const double ahead = (on - place_of(end)).dot(t) / spacing;
    if ((on - place).norm() > tolerance_ * spacing || ahead > reach_ || ahead < -2.0) continue;
    if ((on - beside).norm() > 2.0 * spacing) continue;  // beyond its end
    if (std::abs(tangent_at(target.fit, on).dot(t)) > 0.94) continue;
    return on;
  }
  return std::nullopt;
}

/// Ends that still are free go to the inside of a piece that they would meet.
void Meeting::to_insides(Corners& corners) const {
  const NodeIndex index(pieces_);
  const auto corner_of = [&](std::size_t end) -> std::size_t& {
    return corners.of_ends[ends_[end].piece][ends_[end].side];
  };
  std::vector<std::optional<Vec3>> places(ends_.size());
  parallel_blocks(ends_.size(), kEndsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (corner_of(e) == Corners::kNoCorner) places[e] = place_inside(e, index);
    }
  });
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    if (!places[e]) continue;
    corner_of(e) = corners.places.size();
    corners.places.push_back(*places[e]);
  }
}

Corners Meeting::solve() {
  for (const Candidate& pair : candidates()) {
    const std::size_t a = group_[pair.a], b = group_[pair.b];
    if (a == b) continue;
    std::vector<std::size_t> all = members_[a];
    all.insert(all.end(), members_[b].begin(), members_[b].end());
    if (all.size() > 2 && (closes_a_piece(all) || !std::isfinite(cost_at(all, meet(all)))))
      continue;
    for (const std::size_t end : members_[b]) group_[end] = a;
    members_[a] = std::move(all);
    members_[b].clear();
  }
  Corners corners;
  corners.of_ends.assign(pieces_.size(), {Corners::kNoCorner, Corners::kNoCorner});
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    if (members_[e].size() < 2) continue;
    for (const std::size_t end : members_[e]) {
      corners.of_ends[ends_[end].piece][ends_[end].side] = corners.places.size();
    }
    corners.places.push_back(meet(members_[e]));
  }
  to_insides(corners);
  return corners;
}

}  // namespace

Corners find_corners(const std::vector<Piece>& pieces, double reach, double tolerance) {
  return Meeting(pieces, reach, tolerance).solve();
}

Corners find_corners(const std::vector<Piece>& pieces, double noise) {
  return find_corners(pieces, kCornerReach, kCornerTolerance + noise);
}

std::vector<End> free_ends(const std::vector<Piece>& pieces, double noise) {
  const Corners corners = find_corners(pieces, noise);
  std::vector<End> ends = open_ends(pieces);
  std::erase_if(ends, [&](const End& end) {
    return corners.of_ends[end.piece][end.side] != Corners::kNoCorner;
  });
  return ends;
}

}  // namespace pcednet::lines
