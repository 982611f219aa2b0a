#include "pcednet/lines/pieces/bores.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "pcednet/core/parallel.h"
#include "pcednet/lines/pieces/common_axes.h"
#include "pcednet/lines/pieces/observe.h"
#include "pcednet/lines/pieces/prism.h"
#include "pcednet/lines/pieces/rim.h"
#include "pcednet/lines/pieces/ring.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLongPiece = 8;    ///< nodes
constexpr std::size_t kLeastAround = 8;  ///< nodes of a circle
constexpr std::size_t kLeastAlong = 2;   ///< nodes of a side of a polygon
constexpr std::size_t kSeedsAtOnce = 64;
constexpr double kMostNoiseOfBores = 0.1;

constexpr RimTest kExactRim = {.reach = 0.03, .plane = 4, .missing = 2, .off = 1.0, .share = 0.0};
constexpr RimTest kMeasuredRim = {
    .reach = 0.15, .plane = 6, .missing = 1, .off = 1.0 / 3.0, .share = 2.0 / 3.0};
constexpr double kReachInNoise = 0.5;  ///< added, times the noise

// In spacings.
constexpr double kExplained = 1.2;  ///< edge points nearer to a long piece start no search
constexpr double kBetweenExact = 1.5, kBetweenMeasured = 2.5;  ///< of those that do
constexpr double kOneRim = 1.0;                                ///< two circles less apart are one

/// Edge points that no long piece explains; one of those near each other.
std::vector<std::uint32_t> unexplained(const std::vector<Piece>& pieces, const OrderedPoints& cloud,
                                       const Sampling& sampling) {
  const double spacing = sampling.spacing;
  const double between = sampling.exact ? kBetweenExact : kBetweenMeasured;
  std::vector<std::uint8_t> explained(cloud.size(), 0);
  std::vector<spatial::Neighbour> near;
  const auto explain = [&](const Vec3& place, double reach) {
    cloud.within(place, reach * spacing, near);
    for (const auto& point : near) explained[point.index] = 1;
  };
  for (const Piece& piece : pieces) {
    if (!piece.closed && !is_exact_arc(piece) && piece.nodes.size() < kLongPiece) continue;
    for (const ChainNode& node : piece.nodes) explain(node.at, kExplained);
  }
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_edge(i) || explained[i]) continue;
    found.push_back(static_cast<std::uint32_t>(i));
    explain(cloud.position(i), between);
  }
  return found;
}

ChainNode node_of(const Rim& rim, const Vec3& at, const Vec3& out, double spacing) {
  const Vec3& axis = rim.circle.direction;
  return {.at = at,
          .along = axis.cross(out),
          .side_a = axis,
          .side_b = rim.is_bore ? out : Vec3(-out),
          .spacing = spacing};
}

/// The sides of the polygon with these corners; of exact points they may be short.
void add_sides(const std::vector<Vec3>& corners, const Rim& rim, const OrderedPoints& cloud,
               const Sampling& sampling, std::vector<Piece>& pieces) {
  const double spacing = sampling.spacing;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &from = corners[i], &to = corners[(i + 1) % corners.size()];
    const Vec3 along = (to - from).normalized(), out = along.cross(rim.circle.direction);
    Piece piece{.fit = {CurveKind::kSegment, from, along},
                .nodes = {},
                .ends = {from, to},
                .exact = sampling.exact};
    const auto count =
        std::max(kLeastAlong, static_cast<std::size_t>((to - from).norm() / spacing));
    add_observed_nodes(piece, count, node_of(rim, from, out, spacing), cloud);
    pieces.push_back(std::move(piece));
  }
}

Piece piece_of(const Rim& rim, const OrderedPoints& cloud, double spacing) {
  const Fit& circle = rim.circle;
  Piece piece{.fit = circle, .nodes = {}, .ends = {}, .closed = true};
  const double around = kWholeTurn * circle.radius / spacing;
  const std::size_t count = std::max(kLeastAround, static_cast<std::size_t>(around));
  const Vec3 x = circle.direction.unitOrthogonal(), y = circle.direction.cross(x);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = kWholeTurn * static_cast<double>(i) / static_cast<double>(count);
    const Vec3 out = std::cos(angle) * x + std::sin(angle) * y;
    piece.nodes.push_back(node_of(rim, circle.point + circle.radius * out, out, spacing));
    observe(piece.nodes.back(), cloud);
  }
  piece.ends = {piece.nodes.front().at, piece.nodes.front().at};
  return piece;
}

/// The rims, each once, that are no circle already.
std::vector<Rim> new_rims(const std::vector<std::optional<Rim>>& found,
                          const std::vector<Piece>& pieces, double spacing) {
  std::vector<Fit> known;
  for (const Piece& piece : pieces) {
    if (piece.closed && piece.fit.kind == CurveKind::kArc) known.push_back(piece.fit);
  }
  std::vector<Rim> rims;
  for (const auto& rim : found) {
    if (!rim) continue;
    const Fit& circle = rim->circle;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const Fit& other) {
      const double apart = (other.point - circle.point).norm();
      return apart + std::abs(other.radius - circle.radius) < kOneRim * spacing;
    });
    if (is_known) continue;
    known.push_back(circle);
    rims.push_back(*rim);
  }
  return rims;
}

/// Removes the open pieces that are of a rim.
void erase_pieces_of(const std::vector<Rim>& rims, std::vector<Piece>& pieces, double spacing) {
  const NodeIndex index(pieces);
  std::vector<std::uint8_t> gone(pieces.size(), 0);
  std::vector<spatial::Neighbour> near;
  for (const Rim& rim : rims) {
    index.tree.within_unsorted(rim.circle.point, rim.circle.radius + spacing, near);
    for (const auto& node : near) {
      const std::size_t j = index.piece[node.index];
      if (pieces[j].closed || is_exact_arc(pieces[j])) continue;
      if (!gone[j]) gone[j] = belongs_to(rim.circle, pieces[j]);
    }
  }
  erase_marked(pieces, gone);
}

EndIndex ends_of_segments(const std::vector<Piece>& pieces) {
  std::vector<End> ends = open_ends(pieces);
  std::erase_if(ends,
                [&](const End& end) { return pieces[end.piece].fit.kind != CurveKind::kSegment; });
  return EndIndex(pieces, std::move(ends));
}

}  // namespace

void find_bores(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
                const Progress* progress) {
  if (sampling.noise > kMostNoiseOfBores) return;
  const double spacing = sampling.spacing;
  RimTest measured = kMeasuredRim;
  measured.reach += kReachInNoise * sampling.noise;
  const std::vector<std::uint32_t> seeds = unexplained(pieces, cloud, sampling);
  const std::vector<Vec3> axes = sampling.exact ? common_axes(pieces) : std::vector<Vec3>();
  std::vector<std::optional<Rim>> found(seeds.size());
  Stage stage(progress, "bores", seeds.size());
  parallel_blocks(seeds.size(), kSeedsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (sampling.exact) found[k] = rim_near(cloud, seeds[k], axes, kExactRim, spacing);
      if (!found[k]) found[k] = rim_near(cloud, seeds[k], {}, measured, spacing);
    }
    stage.advance(end - begin);
  });
  const std::vector<Rim> rims = new_rims(found, pieces, spacing);
  if (rims.empty()) return;
  erase_pieces_of(rims, pieces, spacing);
  const EndIndex ends = ends_of_segments(pieces);
  std::vector<Piece> added;
  for (const Rim& rim : rims) {
    const std::vector<Vec3> corners = corners_of_prism(rim, pieces, ends, cloud, spacing);
    if (corners.empty()) {
      added.push_back(piece_of(rim, cloud, spacing));
    } else {
      add_sides(corners, rim, cloud, sampling, added);
    }
  }
  append(pieces, std::move(added));
}

}  // namespace pcednet::lines
