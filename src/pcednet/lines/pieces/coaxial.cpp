#include "pcednet/lines/pieces/coaxial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/pieces/ring.h"

namespace pcednet::lines {
namespace {

constexpr double kLeastAxisRadius = 2.5, kOneAxis = 0.5;  ///< in spacings
constexpr double kOneAxisCosine = 0.999;
constexpr double kFar = 100.0, kFarInRadii = 4.0;      ///< from a circle: spacings and its radii
constexpr double kOnAxis = 3.0, kOnAxisInNoise = 4.0;  ///< of nodes to their circle, in tolerances
constexpr double kNoisyTolerance = 0.28;
constexpr double kLeastCovered = 0.5;         ///< of the circle, by nodes
constexpr double kLeastCoveredOnEdges = 0.4;  ///< the same where edge points follow it
constexpr std::size_t kLeastAbout = 3;        ///< nodes of a piece

/// A piece as part of a circle about an axis.
struct AboutAxis {
  std::size_t piece;
  double radius, height;
};

/// Mean radius and height of the nodes about the axis; nothing if one in five is not on that
/// circle.
std::optional<AboutAxis> piece_about(const Fit& axis, const Piece& piece, std::size_t index,
                                     double reach) {
  const auto count = static_cast<double>(piece.nodes.size());
  AboutAxis found{index, 0.0, 0.0};
  for (const ChainNode& node : piece.nodes) {
    const Eigen::Vector2d place = about_axis(axis, node.at);
    found.radius += place.x() / count;
    found.height += place.y() / count;
  }
  if (found.radius < kSmallestRadius * piece.spacing()) return std::nullopt;
  std::size_t on = 0;
  for (const ChainNode& node : piece.nodes) {
    const Eigen::Vector2d place = about_axis(axis, node.at);
    on += std::hypot(place.x() - found.radius, place.y() - found.height) < reach * node.spacing &&
          std::abs(tangent_at(axis, node.at).dot(node.along)) > 0.8;
  }
  if (5 * on < 4 * piece.nodes.size()) return std::nullopt;
  return found;
}

/// The share of the circle that nodes lie along.
double covered_share(const Fit& circle, const std::vector<ChainNode>& nodes) {
  const double around = kWholeTurn * circle.radius / nodes.front().spacing;
  const auto count = static_cast<std::size_t>(std::clamp(around / 2.0, 6.0, 360.0));
  Sectors sectors(circle, count);
  for (const ChainNode& node : nodes) sectors.add(node.at);
  return static_cast<double>(sectors.covered()) / static_cast<double>(count);
}

/// How far from a circle others on its axis are sought: a sheet may have thousands of holes.
double reach_from(const Piece& circle) {
  return kFar * circle.spacing() + kFarInRadii * circle.fit.radius;
}

bool is_on_axis(const Piece& circle, const Fit& axis) {
  const Vec3 offset = circle.fit.point - axis.point;
  const Vec3 aside = offset - offset.dot(axis.direction) * axis.direction;
  return std::abs(axis.direction.dot(circle.fit.direction)) > kOneAxisCosine &&
         aside.norm() < kOneAxis * circle.spacing();
}

/// Closed circles, of those near each other on one axis the longest only. `order` is that of
/// longest_first().
std::vector<std::size_t> circles_of_axes(const std::vector<Piece>& pieces,
                                         const std::vector<std::size_t>& order) {
  std::vector<std::size_t> circles;
  std::vector<Vec3> centres;
  for (const std::size_t i : order) {
    const Piece& piece = pieces[i];
    if (!piece.closed || piece.fit.kind != CurveKind::kArc) continue;
    if (piece.fit.radius < kLeastAxisRadius * piece.spacing()) continue;
    circles.push_back(i);
    centres.push_back(piece.fit.point);
  }
  const spatial::KdTree tree(centres);
  std::vector<std::uint8_t> kept(circles.size(), 0);
  std::vector<std::size_t> found;
  std::vector<spatial::Neighbour> near;
  for (std::size_t n = 0; n < circles.size(); ++n) {
    const Piece& circle = pieces[circles[n]];
    tree.within_unsorted(centres[n], reach_from(circle), near);
    const bool known = std::any_of(near.begin(), near.end(), [&](const auto& other) {
      return kept[other.index] && is_on_axis(circle, pieces[circles[other.index]].fit);
    });
    kept[n] = !known;
    if (!known) found.push_back(circles[n]);
  }
  return found;
}

/// The open pieces, by the places of their middles.
struct OpenPieces {
  OpenPieces(const std::vector<Piece>& pieces, const std::vector<std::size_t>& order) : tree({}) {
    std::vector<Vec3> middles;
    for (const std::size_t i : order) {
      if (pieces[i].closed || pieces[i].nodes.size() < kLeastAbout) continue;
      longest_first.push_back(i);
      middles.push_back(pieces[i].middle().at);
    }
    tree = spatial::KdTree(middles);
  }
  std::vector<std::size_t> longest_first;
  spatial::KdTree tree;
};

/// The pieces about the axis of `circle` that are still open, the longest first.
std::vector<AboutAxis> pieces_about(const Piece& circle, const std::vector<Piece>& pieces,
                                    const OpenPieces& open, double reach) {
  std::vector<spatial::Neighbour> near;
  open.tree.within_unsorted(circle.fit.point, reach_from(circle), near);
  std::sort(near.begin(), near.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  std::vector<AboutAxis> around;
  for (const auto& other : near) {
    const std::size_t i = open.longest_first[other.index];
    if (pieces[i].closed) continue;
    if (const auto about = piece_about(circle.fit, pieces[i], i, reach)) around.push_back(*about);
  }
  return around;
}

/// The circle about `axis` of the open pieces that are on one with `first`; they are `joined`.
Piece circle_about(const Fit& axis, const std::vector<Piece>& pieces,
                   const std::vector<AboutAxis>& around, const AboutAxis& first, double reach,
                   std::vector<std::size_t>& joined) {
  const ChainNode& like = pieces[first.piece].middle();
  Piece whole{.fit = axis, .nodes = {}, .ends = {}, .closed = true};
  joined.clear();
  double radius = 0.0, height = 0.0;
  for (const AboutAxis& other : around) {
    const Piece& piece = pieces[other.piece];
    const double away = std::hypot(other.radius - first.radius, other.height - first.height);
    if (piece.closed || away > reach * piece.spacing()) continue;
    if (&other != &first && !same_wedge(axis, like, piece.middle())) continue;
    const auto nodes = static_cast<double>(piece.nodes.size());
    radius += nodes * other.radius;
    height += nodes * other.height;
    whole.nodes.insert(whole.nodes.end(), piece.nodes.begin(), piece.nodes.end());
    joined.push_back(other.piece);
  }
  const auto count = static_cast<double>(whole.nodes.size());
  whole.fit.radius = radius / count;
  whole.fit.point += height / count * axis.direction;
  return whole;
}

}  // namespace

void complete_coaxial(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance) {
  const PieceIndex index(pieces);
  std::vector<std::uint8_t> gone(pieces.size(), 0);
  const double reach = (tolerance > kNoisyTolerance ? kOnAxisInNoise : kOnAxis) * tolerance;
  const std::vector<std::size_t> order = longest_first(pieces);
  const OpenPieces open(pieces, order);
  std::vector<std::size_t> joined;
  for (const std::size_t circle : circles_of_axes(pieces, order)) {
    const std::vector<AboutAxis> around = pieces_about(pieces[circle], pieces, open, reach);
    const Fit axis = pieces[circle].fit;
    std::vector<std::size_t> concentric;  // block no gap
    for (const AboutAxis& about : around) concentric.push_back(about.piece);
    std::sort(concentric.begin(), concentric.end());
    for (const AboutAxis& first : around) {
      if (pieces[first.piece].closed) continue;
      Piece whole = circle_about(axis, pieces, around, first, reach, joined);
      const double covered = covered_share(whole.fit, whole.nodes);
      if (covered < kLeastCoveredOnEdges) continue;
      const std::vector<Gap> gaps = sort_about_axis(whole.fit, whole.nodes);
      if (!edges_follow(whole.fit, gaps, whole.spacing(), cloud)) {
        if (covered < kLeastCovered || is_blocked(gaps, pieces, index, concentric)) continue;
      }
      whole.ends = {whole.nodes.front().at, whole.nodes.front().at};
      for (const std::size_t j : joined) {
        gone[j] = 1;
        pieces[j].closed = true;  // not to be joined again
      }
      gone[first.piece] = 0;
      pieces[first.piece] = std::move(whole);
    }
  }
  erase_marked(pieces, gone);
}

}  // namespace pcednet::lines
