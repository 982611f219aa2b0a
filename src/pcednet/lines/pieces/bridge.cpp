#include "pcednet/lines/pieces/bridge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/lines/pieces/corners.h"

namespace pcednet::lines {
namespace {

// In spacings.
constexpr double kWidest = 30.0;    ///< gap; nor are gaps wider than both pieces together
constexpr double kOnSurface = 1.2;  ///< of a point of the cloud from a place of the bridge
constexpr double kBetween = 1.0;    ///< from such a place to the next

struct Bridge {
  End a, b;
  double gap;  ///< in spacings
};

/// Whether points of the cloud follow the joined curve from one place to the other.
bool surface_between(const Fit& fit, const Vec3& from, const Vec3& to, double spacing,
                     const OrderedPoints& cloud) {
  const auto steps = static_cast<int>(std::ceil((to - from).norm() / (kBetween * spacing)));
  std::vector<spatial::Neighbour> near;
  int there = 0;
  for (int i = 1; i < steps; ++i) {
    const Vec3 place = nearest_on(fit, from + (to - from) * i / steps);
    cloud.within(place, kOnSurface * spacing, near);
    there += near.empty() ? 0 : 1;
  }
  return 5 * there >= 4 * (steps - 1);
}

/// Which ends of each piece a bridge may begin at.
using FreeEnds = std::vector<std::array<bool, 2>>;

/// Those in no corner, but for the ends of polylines.
FreeEnds ends_to_bridge(const std::vector<Piece>& pieces, double noise) {
  FreeEnds free(pieces.size());
  for (const auto& [piece, side] : free_ends(pieces, noise)) {
    free[piece][side] = pieces[piece].fit.kind != CurveKind::kPolyline;
  }
  return free;
}

/// Pairs of free ends of one wedge, those nearest to each other first. The longer piece comes
/// first.
std::vector<Bridge> bridges_of(const std::vector<Piece>& pieces, const FreeEnds& free) {
  std::vector<End> ends = open_ends(pieces);
  std::erase_if(ends, [&](const End& end) { return !free[end.piece][end.side]; });
  const EndIndex index(pieces, std::move(ends));
  std::vector<Bridge> bridges;
  std::vector<spatial::Neighbour> near;
  for (std::size_t e = 0; e < index.ends.size(); ++e) {
    const End& a = index.ends[e];
    const Piece& piece = pieces[a.piece];
    const double spacing = piece.spacing(), length = length_of(piece);
    index.tree.within(index.places[e], std::min(kWidest * spacing, 2.0 * length), near);
    const Vec3 out = outward(piece, a.side);
    for (const auto& other : near) {
      const End& b = index.ends[other.index];
      const Piece& next = pieces[b.piece];
      const double its_length = length_of(next), gap = std::sqrt(other.sq_distance);
      if (its_length > length || (its_length == length && other.index <= e)) continue;
      if (a.piece == b.piece || gap > length + its_length) continue;
      if (!same_wedge(node_at(piece, a.side), node_at(next, b.side))) continue;
      if ((index.places[other.index] - index.places[e]).dot(out) < -spacing) continue;
      bridges.push_back({a, b, gap / spacing});
    }
  }
  std::stable_sort(bridges.begin(), bridges.end(),
                   [](const Bridge& a, const Bridge& b) { return a.gap < b.gap; });
  return bridges;
}

/// One pass of bridges, no piece in two of them; true if there was one.
bool bridge_once(std::vector<Piece>& pieces, FreeEnds& free, const OrderedPoints& cloud,
                 double tolerance) {
  std::vector<std::uint8_t> changed(pieces.size(), 0), gone(pieces.size(), 0);
  bool any = false;
  for (const auto& [a, b, gap] : bridges_of(pieces, free)) {
    if (changed[a.piece] || changed[b.piece]) continue;
    const Piece &from = pieces[a.piece], &to = pieces[b.piece];
    auto both = joined_at(from, a.side, to, b.side, tolerance);
    if (!both ||
        !surface_between(both->fit, from.ends[a.side], to.ends[b.side], from.spacing(), cloud)) {
      continue;
    }
    pieces[a.piece] = std::move(*both);
    free[a.piece] = {free[a.piece][1 - a.side], free[b.piece][1 - b.side]};
    changed[a.piece] = changed[b.piece] = gone[b.piece] = 1;
    any = true;
  }
  erase_marked(pieces, gone);
  std::size_t i = 0;
  std::erase_if(free, [&](const auto&) { return gone[i++] != 0; });
  return any;
}

}  // namespace

void bridge_gaps(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance,
                 double noise) {
  FreeEnds free = ends_to_bridge(pieces, noise);
  while (bridge_once(pieces, free, cloud, tolerance)) {
  }
}

}  // namespace pcednet::lines
