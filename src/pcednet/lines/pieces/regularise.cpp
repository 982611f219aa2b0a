#include "pcednet/lines/pieces/regularise.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

#include "pcednet/core/half_space.h"
#include "pcednet/core/sort_unique.h"

namespace pcednet::lines {
namespace {

constexpr double kSnap = 0.07;     ///< sine of the largest turn
constexpr double kApart = 0.7;     ///< sine of the least angle between two directions with a normal
constexpr double kMostMove = 2.0;  ///< of a corner, in spacings
constexpr double kMostOfEnd = 1.0;  ///< of an end by a turn, in spacings: farther, it is no noise
/// Weights of directions relative to the places of corners: exact to rounding, or a compromise.
constexpr double kExactly = 1e9, kNearly = 3.0;
constexpr int kHoldRounds = 30;
constexpr double kContradicting = 0.7;  ///< of the largest turn

/// The direction of a segment that shorter ones may follow.
struct Reference {
  Vec3 direction;
  std::size_t piece;
};

/// A direction and the references that it follows.
struct Turned {
  Vec3 direction;
  std::vector<std::size_t> after;  ///< pieces
};

/// The direction made orthogonal to the first two references that it nearly is.
Turned made_orthogonal(const Vec3& own, const std::vector<Reference>& references) {
  Turned turned = {own, {}};
  const Reference* first = nullptr;
  for (const Reference& reference : references) {
    const Vec3& d = reference.direction;
    if (std::abs(own.dot(d)) > kSnap) continue;
    if (!first) {
      first = &reference;
      turned = {(own - own.dot(d) * d).normalized(), {reference.piece}};
      continue;
    }
    const Vec3 normal = first->direction.cross(d);
    if (normal.norm() < kApart || own.cross(normal.normalized()).norm() > 2.0 * kSnap) continue;
    return {turned_to(normal.normalized(), own), {first->piece, reference.piece}};
  }
  return turned;
}

/// Whether the segment's ends stay about where they are if it takes that direction.
bool may_turn_to(const Piece& piece, const Vec3& direction) {
  Fit turned = piece.fit;
  turned.direction = direction;
  return std::ranges::all_of(piece.ends, [&](const Vec3& end) {
    return (nearest_on(turned, end) - end).norm() <= kMostOfEnd * piece.spacing();
  });
}

/// A regular segment between two corners.
struct HeldSegment {
  std::size_t a, b;
  Vec3 direction;
};

std::vector<HeldSegment> held_segments(const std::vector<Piece>& pieces, const Corners& corners) {
  std::vector<HeldSegment> held;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [a, b] = corners.of_ends[i];
    if (!pieces[i].regular || a == Corners::kNoCorner || b == Corners::kNoCorner || a == b)
      continue;
    held.push_back({a, b, pieces[i].fit.direction});
  }
  return held;
}

/// The held segments of each connected group of corners.
std::vector<std::vector<HeldSegment>> connected(const std::vector<HeldSegment>& held,
                                                std::size_t corners) {
  std::vector<std::size_t> parent(corners);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const HeldSegment& segment : held) parent[root(segment.a)] = root(segment.b);
  std::vector<std::vector<HeldSegment>> of_root(corners);
  for (const HeldSegment& segment : held) of_root[root(segment.a)].push_back(segment);
  std::erase_if(of_root, [](const std::vector<HeldSegment>& group) { return group.empty(); });
  return of_root;
}

/// Places of corners with numbers in ascending order.
struct Group {
  std::vector<std::size_t> corners;
  std::vector<Vec3> places;

  std::size_t number_of(std::size_t corner) const {
    return static_cast<std::size_t>(std::lower_bound(corners.begin(), corners.end(), corner) -
                                    corners.begin());
  }
};

Group corners_of(const std::vector<HeldSegment>& held, const Corners& corners) {
  Group group;
  for (const HeldSegment& segment : held)
    group.corners.insert(group.corners.end(), {segment.a, segment.b});
  sort_unique(group.corners);
  for (const std::size_t c : group.corners) group.places.push_back(corners.places[c]);
  return group;
}

/// The places p that minimise, with p0 those before and d the directions of segments a b,
///
///     sum |p - p0|^2 + weight sum |(I - d d^T) (p_a - p_b)|^2 .
std::vector<Vec3> solved(const Group& group, const std::vector<HeldSegment>& held, double weight) {
  const Vec3 origin = group.places.front();
  const auto size = static_cast<int>(3 * group.places.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(size);
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 1.0);
    right[i] = (group.places[static_cast<std::size_t>(i / 3)] - origin)[i % 3];
  }
  for (const HeldSegment& segment : held) {
    const Mat3 across =
        weight * (Mat3::Identity() - segment.direction * segment.direction.transpose());
    const int a = 3 * static_cast<int>(group.number_of(segment.a)),
              b = 3 * static_cast<int>(group.number_of(segment.b));
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        entries.emplace_back(a + r, a + c, across(r, c));
        entries.emplace_back(b + r, b + c, across(r, c));
        entries.emplace_back(a + r, b + c, -across(r, c));
        entries.emplace_back(b + r, a + c, -across(r, c));
      }
    }
  }
  Eigen::SparseMatrix<double> left(size, size);
  left.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(left);
  const Eigen::VectorXd solution = factors.solve(right);
  std::vector<Vec3> places;
  for (int i = 0; i < size; i += 3) places.push_back(origin + solution.segment<3>(i));
  return places;
}

double largest_move(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double largest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double move = (to[i] - from[i]).norm();
    if (!std::isfinite(move)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, move);
  }
  return largest;
}

double mean_spacing(const std::vector<Piece>& pieces) {
  double sum = 0.0;
  for (const Piece& piece : pieces) sum += piece.spacing();
  return sum / static_cast<double>(std::max<std::size_t>(pieces.size(), 1));
}

/// Moves the end of a regular segment that no corner holds onto the line through the other end.
void follow(Piece& piece, const std::array<std::size_t, 2>& corners,
            const std::vector<Vec3>& places) {
  for (const std::size_t side : {0, 1}) {
    const std::size_t held = corners[1 - side];
    if (corners[side] != Corners::kNoCorner || held == Corners::kNoCorner) continue;
    const Vec3& d = piece.fit.direction;
    piece.ends[side] = places[held] + d.dot(piece.ends[side] - places[held]) * d;
  }
}

/// Removes the segments that a compromise turns the most: they contradict the others.
void drop_contradicting(std::vector<HeldSegment>& held, const Group& group) {
  const std::vector<Vec3> places = solved(group, held, kNearly);
  const auto turn = [&](const HeldSegment& segment) {
    const Vec3 between = places[group.number_of(segment.b)] - places[group.number_of(segment.a)];
    return between.normalized().cross(segment.direction).norm();
  };
  double largest = 0.0;
  for (const HeldSegment& segment : held) largest = std::max(largest, turn(segment));
  std::erase_if(held, [&](const HeldSegment& s) { return turn(s) >= kContradicting * largest; });
}

/// The places of the group's corners with the directions of its segments, without those that
/// contradict the others; nothing if that asks for too much.
std::optional<std::vector<Vec3>> regular_places(const Group& group, std::vector<HeldSegment> held,
                                                double most) {
  for (int round = 0; round < kHoldRounds && !held.empty(); ++round) {
    std::vector<Vec3> places = solved(group, held, kExactly);
    if (largest_move(group.places, places) <= most) return places;
    drop_contradicting(held, group);
  }
  return std::nullopt;
}

}  // namespace

void regularise(std::vector<Piece>& pieces) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].fit.kind == CurveKind::kSegment) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return length_of(pieces[a]) > length_of(pieces[b]);
  });
  std::vector<Reference> references;
  for (const std::size_t i : order) {
    const Vec3 own = pieces[i].fit.direction;
    const auto parallel =
        std::find_if(references.begin(), references.end(), [&](const Reference& reference) {
          return own.cross(reference.direction).norm() < kSnap &&
                 may_turn_to(pieces[i], turned_to(reference.direction, own));
        });
    Turned turned;
    if (parallel != references.end()) {
      turned = {turned_to(parallel->direction, own), {parallel->piece}};
    } else {
      turned = made_orthogonal(own, references);
      if (!may_turn_to(pieces[i], turned.direction)) turned = {own, {}};
      references.push_back({turned.direction, i});
    }
    pieces[i].fit.direction = turned.direction;
    pieces[i].regular = !turned.after.empty();
    for (const std::size_t longer : turned.after) pieces[longer].regular = true;
    for (Vec3& end : pieces[i].ends) end = nearest_on(pieces[i].fit, end);
  }
}

void hold_directions(std::vector<Piece>& pieces, Corners& corners) {
  const double most = kMostMove * mean_spacing(pieces);
  for (const std::vector<HeldSegment>& held :
       connected(held_segments(pieces, corners), corners.places.size())) {
    const Group group = corners_of(held, corners);
    const auto places = regular_places(group, held, most);
    if (!places) continue;
    for (std::size_t i = 0; i < places->size(); ++i)
      corners.places[group.corners[i]] = (*places)[i];
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].regular) follow(pieces[i], corners.of_ends[i], corners.places);
  }
}

}  // namespace pcednet::lines
