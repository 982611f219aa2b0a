#include "pcednet/lines/corners.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr int kMeetSteps = 6;
constexpr double kPull = 1e-3;  ///< towards the ends, where curves are parallel

struct End {
  std::size_t piece;
  std::size_t side;
};

class Meeting {
 public:
  Meeting(const std::vector<Piece>& pieces, double reach, double tolerance)
      : pieces_(pieces), reach_(reach), tolerance_(tolerance) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i].closed) continue;
      ends_.push_back({i, 0});
      ends_.push_back({i, 1});
    }
    parent_.resize(ends_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    members_.resize(ends_.size());
    for (std::size_t e = 0; e < ends_.size(); ++e) members_[e] = {e};
  }

  Corners solve();

 private:
  struct Candidate {
    std::size_t a, b;
    double cost;
  };

  const Piece& piece_of(std::size_t end) const { return pieces_[ends_[end].piece]; }
  const Vec3& place_of(std::size_t end) const { return piece_of(end).ends[ends_[end].side]; }
  Vec3 outward(std::size_t end) const {
    const Piece& piece = piece_of(end);
    const ChainNode& node = ends_[end].side == 0 ? piece.nodes.front() : piece.nodes.back();
    const Vec3 along =
        piece.fit.kind == CurveKind::kPolyline ? node.along : tangent_at(piece.fit, place_of(end));
    const Vec3 forward = along.dot(node.along) < 0.0 ? Vec3(-along) : along;
    return ends_[end].side == 0 ? Vec3(-forward) : forward;
  }
  Vec3 nearest(std::size_t end, const Vec3& place) const {
    const Piece& piece = piece_of(end);
    if (piece.fit.kind != CurveKind::kPolyline) return nearest_on(piece.fit, place);
    const Vec3 along = outward(end);
    return place_of(end) + (place - place_of(end)).dot(along) * along;
  }
  Vec3 meet(const std::vector<std::size_t>& ends) const;
  double cost_at(const std::vector<std::size_t>& ends, const Vec3& place) const;
  std::vector<Candidate> candidates() const;
  std::size_t root(std::size_t end) const {
    while (parent_[end] != end) end = parent_[end];
    return end;
  }
  void to_insides(Corners& corners) const;

  const std::vector<Piece>& pieces_;
  double reach_, tolerance_;
  std::vector<End> ends_;
  std::vector<std::size_t> parent_;
  std::vector<std::vector<std::size_t>> members_;
};

/// The place nearest to all their curves, by least squares.
Vec3 Meeting::meet(const std::vector<std::size_t>& ends) const {
  Vec3 centre = Vec3::Zero();
  for (const std::size_t end : ends) centre += place_of(end) / static_cast<double>(ends.size());
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
      left += across;
      right += across * (on - place);
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
    if (!(aside < tolerance_) || offset.norm() > reach_ * spacing) {
      return std::numeric_limits<double>::infinity();
    }
    if (ahead < -std::min(3.5, 0.5 * length)) return std::numeric_limits<double>::infinity();
    cost += std::abs(ahead) + 2.0 * aside;
  }
  return cost;
}

std::vector<Meeting::Candidate> Meeting::candidates() const {
  std::vector<Vec3> places;
  for (std::size_t e = 0; e < ends_.size(); ++e) places.push_back(place_of(e));
  const spatial::KdTree tree(places);
  std::vector<Candidate> found;
  std::vector<spatial::Neighbour> near;
  for (std::size_t a = 0; a < ends_.size(); ++a) {
    tree.within(places[a], 1.5 * reach_ * piece_of(a).spacing(), near);
    for (const auto& other : near) {
      const std::size_t b = other.index;
      if (b <= a || ends_[a].piece == ends_[b].piece) continue;
      const std::vector<std::size_t> both = {a, b};
      const double cost = cost_at(both, meet(both));
      if (std::isfinite(cost)) found.push_back({a, b, cost});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return found;
}

/// Ends that still are free go to the inside of a piece that they would meet.
void Meeting::to_insides(Corners& corners) const {
  std::vector<Vec3> places;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    for (const ChainNode& node : pieces_[i].nodes) {
      places.push_back(node.at);
      owner.push_back(i);
    }
  }
  const spatial::KdTree tree(places);
  std::vector<spatial::Neighbour> near;
  for (std::size_t end = 0; end < ends_.size(); ++end) {
    const auto [piece, side] = ends_[end];
    if (corners.of_ends[piece][side] != Corners::kNoCorner) continue;
    const double spacing = piece_of(end).spacing();
    tree.within(place_of(end), reach_ * spacing, near);
    for (const auto& other : near) {
      const Piece& target = pieces_[owner[other.index]];
      if (owner[other.index] == piece || target.fit.kind == CurveKind::kPolyline) continue;
      const Vec3 t = outward(end);
      // Where the end's tangent passes the target nearest.
      Vec3 place = places[other.index];
      for (int step = 0; step < 20; ++step) place = nearest(end, nearest_on(target.fit, place));
      const Vec3 on = nearest_on(target.fit, place);
      const double ahead = (on - place_of(end)).dot(t) / spacing;
      if ((on - place).norm() > tolerance_ * spacing || ahead > reach_ || ahead < -2.0) continue;
      if ((on - places[other.index]).norm() > 2.0 * spacing) continue;  // beyond its end
      if (std::abs(tangent_at(target.fit, on).dot(t)) > 0.94) continue;
      corners.of_ends[piece][side] = corners.places.size();
      corners.places.push_back(on);
      break;
    }
  }
}

Corners Meeting::solve() {
  for (const Candidate& pair : candidates()) {
    const std::size_t a = root(pair.a), b = root(pair.b);
    if (a == b) continue;
    std::vector<std::size_t> all = members_[a];
    all.insert(all.end(), members_[b].begin(), members_[b].end());
    if (all.size() > 2 && !std::isfinite(cost_at(all, meet(all)))) continue;
    parent_[b] = a;
    members_[a] = std::move(all);
    members_[b].clear();
  }
  Corners corners;
  corners.of_ends.assign(pieces_.size(), {Corners::kNoCorner, Corners::kNoCorner});
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    if (parent_[e] != e || members_[e].size() < 2) continue;
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

}  // namespace pcednet::lines
