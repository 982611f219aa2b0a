#include "pcednet/lines/bridge.h"

#include <algorithm>
#include <cmath>

#include "pcednet/lines/corners.h"

namespace pcednet::lines {
namespace {

// In spacings.
constexpr double kWidest = 30.0;    ///< gap; nor are gaps wider than both pieces together
constexpr double kOnSurface = 1.2;  ///< of a point of the cloud from a place of the bridge
constexpr double kBetween = 1.0;    ///< from such a place to the next

struct Bridge {
  std::size_t a, b;  ///< ends
  double gap;        ///< in spacings
};

/// Whether points of the cloud follow the joined curve from one place to the other.
bool surface_between(const Fit& fit, const Vec3& from, const Vec3& to, double spacing,
                     const OrderedPoints& cloud) {
  const auto steps = static_cast<int>(std::ceil((to - from).norm() / (kBetween * spacing)));
  std::vector<spatial::Neighbour> near;
  int there = 0;
  for (int i = 1; i < steps; ++i) {
    const Vec3 place = nearest_on(fit, from + (to - from) * i / steps);
    cloud.tree().within_unsorted(place, kOnSurface * spacing, near);
    there += near.empty() ? 0 : 1;
  }
  return 5 * there >= 4 * (steps - 1);
}

std::vector<Bridge> bridges_of(const std::vector<Piece>& pieces, const std::vector<End>& ends) {
  std::vector<Vec3> places;
  for (const auto& [piece, side] : ends) places.push_back(pieces[piece].ends[side]);
  const spatial::KdTree tree(places);
  std::vector<Bridge> bridges;
  std::vector<spatial::Neighbour> near;
  for (std::size_t a = 0; a < ends.size(); ++a) {
    const Piece& piece = pieces[ends[a].piece];
    const double spacing = piece.spacing();
    tree.within(places[a], kWidest * spacing, near);
    const Vec3 out = outward(piece, ends[a].side);
    for (const auto& other : near) {
      const std::size_t b = other.index;
      const Piece& next = pieces[ends[b].piece];
      if (b <= a || ends[a].piece == ends[b].piece) continue;
      const double gap = std::sqrt(other.sq_distance) / spacing;
      if (gap * spacing > length_of(piece) + length_of(next)) continue;
      if (!same_wedge(node_at(piece, ends[a].side), node_at(next, ends[b].side))) continue;
      if ((places[b] - places[a]).dot(out) < -spacing) continue;
      bridges.push_back({a, b, gap});
    }
  }
  std::stable_sort(bridges.begin(), bridges.end(),
                   [](const Bridge& a, const Bridge& b) { return a.gap < b.gap; });
  return bridges;
}

/// The ends that no corner holds, of pieces on a line or circle.
std::vector<End> free_ends(const std::vector<Piece>& pieces, double noise) {
  const Corners corners = find_corners(pieces, noise);
  std::vector<End> ends = open_ends(pieces);
  std::erase_if(ends, [&](const End& end) {
    return pieces[end.piece].fit.kind == CurveKind::kPolyline ||
           corners.of_ends[end.piece][end.side] != Corners::kNoCorner;
  });
  return ends;
}

bool bridge_once(std::vector<Piece>& pieces, const OrderedPoints& cloud,
                 const BridgeOptions& options) {
  const std::vector<End> ends = free_ends(pieces, options.noise);
  std::vector<std::uint8_t> changed(pieces.size(), 0), gone(pieces.size(), 0);
  bool any = false;
  for (const Bridge& bridge : bridges_of(pieces, ends)) {
    const End &a = ends[bridge.a], &b = ends[bridge.b];
    if (changed[a.piece] || changed[b.piece]) continue;
    auto both = joined_at(pieces[a.piece], a.side, pieces[b.piece], b.side, options.tolerance);
    if (!both) continue;
    if (!surface_between(both->fit, pieces[a.piece].ends[a.side], pieces[b.piece].ends[b.side],
                         pieces[a.piece].spacing(), cloud)) {
      continue;
    }
    pieces[a.piece] = std::move(*both);
    changed[a.piece] = changed[b.piece] = gone[b.piece] = 1;
    any = true;
  }
  erase_marked(pieces, gone);
  return any;
}

}  // namespace

void bridge_gaps(std::vector<Piece>& pieces, const OrderedPoints& cloud,
                 const BridgeOptions& options) {
  while (bridge_once(pieces, cloud, options)) {
  }
}

}  // namespace pcednet::lines
