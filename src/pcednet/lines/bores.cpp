#include "pcednet/lines/bores.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "pcednet/core/parallel.h"
#include "pcednet/lines/rim.h"
#include "pcednet/lines/ring.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLongPiece = 8;    ///< nodes
constexpr std::size_t kLeastAround = 8;  ///< nodes of a circle
constexpr std::size_t kSeedsAtOnce = 64;
constexpr double kMostNoiseOfBores = 0.1;
constexpr double kOnSurfaces = 0.15, kOnNoisySurfaces = 0.5;  ///< the second times the noise

// In spacings.
constexpr double kExplained = 1.2;     ///< edge points nearer to a long piece start no search
constexpr double kBetweenSeeds = 1.5;  ///< of those that do
constexpr double kOneRim = 1.0;        ///< two circles less apart are one

/// Edge points that no long piece explains; one of those near each other.
std::vector<std::uint32_t> unexplained(const std::vector<Piece>& pieces, const OrderedPoints& cloud,
                                       double spacing) {
  std::vector<std::uint8_t> explained(cloud.size(), 0);
  std::vector<spatial::Neighbour> near;
  const auto explain = [&](const Vec3& place, double reach) {
    cloud.within(place, reach * spacing, near);
    for (const auto& point : near) explained[point.index] = 1;
  };
  for (const Piece& piece : pieces) {
    if (!piece.closed && piece.nodes.size() < kLongPiece) continue;
    for (const ChainNode& node : piece.nodes) explain(node.at, kExplained);
  }
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_edge(i) || explained[i]) continue;
    found.push_back(static_cast<std::uint32_t>(i));
    explain(cloud.position(i), kBetweenSeeds);
  }
  return found;
}

/// What the edge points around say of the node.
void observe(ChainNode& node, const OrderedPoints& cloud) {
  std::vector<spatial::Neighbour> near;
  cloud.within(node.at, node.spacing, near);
  std::erase_if(near, [&](const auto& point) { return !cloud.is_edge(point.index); });
  const auto edges = static_cast<double>(std::max<std::size_t>(near.size(), 1));
  for (const auto& point : near) {
    node.probability += static_cast<double>(cloud.probability(point.index)) / edges;
    if (cloud.edge_class(point.index) == kSharpEdge) node.sharp += 1.0 / edges;
  }
  node.edge_points = 0.5 * static_cast<double>(near.size());  // both nodes beside it see them, too
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
    piece.nodes.push_back({.at = circle.point + circle.radius * out,
                           .along = circle.direction.cross(out),
                           .side_a = circle.direction,
                           .side_b = rim.is_bore ? out : Vec3(-out),
                           .spacing = spacing});
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
      if (!gone[j]) gone[j] = !pieces[j].closed && belongs_to(rim.circle, pieces[j]);
    }
  }
  erase_marked(pieces, gone);
}

}  // namespace

void find_bores(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
                const Progress* progress) {
  if (sampling.noise > kMostNoiseOfBores) return;
  const double spacing = sampling.spacing;
  const double reach = kOnSurfaces + kOnNoisySurfaces * sampling.noise;
  const std::vector<std::uint32_t> seeds = unexplained(pieces, cloud, spacing);
  std::vector<std::optional<Rim>> found(seeds.size());
  Stage stage(progress, "bores", seeds.size());
  parallel_blocks(seeds.size(), kSeedsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) found[k] = rim_near(cloud, seeds[k], reach, spacing);
    stage.advance(end - begin);
  });
  const std::vector<Rim> rims = new_rims(found, pieces, spacing);
  erase_pieces_of(rims, pieces, spacing);
  for (const Rim& rim : rims) pieces.push_back(piece_of(rim, cloud, spacing));
}

}  // namespace pcednet::lines
