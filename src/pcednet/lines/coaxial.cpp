#include "pcednet/lines/coaxial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "pcednet/lines/ring.h"

namespace pcednet::lines {
namespace {

constexpr double kLeastAxisRadius = 2.5, kOneAxis = 0.5;  ///< in spacings
constexpr double kOneAxisCosine = 0.999;
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
std::optional<AboutAxis> about_axis(const Fit& axis, const Piece& piece, std::size_t index,
                                    double reach) {
  const auto count = static_cast<double>(piece.nodes.size());
  AboutAxis found{index, 0.0, 0.0};
  const auto place_of = [&](const Vec3& at) {
    const Vec3 offset = at - axis.point;
    const double height = offset.dot(axis.direction);
    return std::pair((offset - height * axis.direction).norm(), height);
  };
  for (const ChainNode& node : piece.nodes) {
    const auto [radius, height] = place_of(node.at);
    found.radius += radius / count;
    found.height += height / count;
  }
  if (found.radius < kSmallestRadius * piece.spacing()) return std::nullopt;
  std::size_t on = 0;
  for (const ChainNode& node : piece.nodes) {
    const auto [radius, height] = place_of(node.at);
    on += std::hypot(radius - found.radius, height - found.height) < reach * node.spacing &&
          std::abs(tangent_at(axis, node.at).dot(node.along)) > 0.8;
  }
  if (5 * on < 4 * piece.nodes.size()) return std::nullopt;
  return found;
}

/// The share of the circle that nodes lie along.
double covered_share(const Fit& circle, const std::vector<ChainNode>& nodes) {
  const double around = kWholeTurn * circle.radius / nodes.front().spacing;
  const auto sectors = static_cast<std::size_t>(std::clamp(around / 2.0, 6.0, 360.0));
  std::vector<std::uint8_t> seen(sectors, 0);
  const Vec3 x = circle.direction.unitOrthogonal();
  for (const ChainNode& node : nodes) {
    const double turn = angle_at(circle, x, node.at) / kWholeTurn + 0.5;
    seen[std::min(static_cast<std::size_t>(turn * static_cast<double>(sectors)), sectors - 1)] = 1;
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), 1)) /
         static_cast<double>(sectors);
}

/// Axes of closed circles, those of the longest first, each once.
std::vector<Fit> known_axes(const std::vector<Piece>& pieces) {
  std::vector<Fit> axes;
  for (const std::size_t i : longest_first(pieces)) {
    const Piece& piece = pieces[i];
    if (!piece.closed || piece.fit.kind != CurveKind::kArc) continue;
    const double spacing = piece.spacing();
    if (piece.fit.radius < kLeastAxisRadius * spacing) continue;
    const bool known = std::any_of(axes.begin(), axes.end(), [&](const Fit& axis) {
      const Vec3 offset = piece.fit.point - axis.point;
      const Vec3 aside = offset - offset.dot(axis.direction) * axis.direction;
      return std::abs(axis.direction.dot(piece.fit.direction)) > kOneAxisCosine &&
             aside.norm() < kOneAxis * spacing;
    });
    if (!known) axes.push_back(piece.fit);
  }
  return axes;
}

/// The pieces about `axis` that are not `gone`, the longest first.
std::vector<AboutAxis> pieces_about(const Fit& axis, const std::vector<Piece>& pieces,
                                    const std::vector<std::uint8_t>& gone, double reach) {
  std::vector<AboutAxis> around;
  for (const std::size_t i : longest_first(pieces)) {
    if (gone[i] || pieces[i].closed || pieces[i].nodes.size() < kLeastAbout) continue;
    if (const auto about = about_axis(axis, pieces[i], i, reach)) around.push_back(*about);
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
  std::vector<std::size_t> joined;
  for (const Fit& axis : known_axes(pieces)) {
    const std::vector<AboutAxis> around = pieces_about(axis, pieces, gone, reach);
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
