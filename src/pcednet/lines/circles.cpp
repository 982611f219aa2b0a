#include "pcednet/lines/circles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kLeastArc = 5;     ///< nodes
constexpr double kSmallestRadius = 1.2;  ///< in spacings
constexpr double kMostOpen = 0.55;       ///< of a circle that is to be closed
constexpr double kBlocking = 2.5;        ///< spacings from the end of a piece to a gap

/// The pieces as they are at first, by their first nodes and by their ends.
struct Index {
  explicit Index(const std::vector<Piece>& pieces);

  spatial::KdTree starts;  ///< the first node of each piece
  EndIndex open;
  double largest_spacing = 0.0;
};

Index::Index(const std::vector<Piece>& pieces) : starts({}), open(pieces, open_ends(pieces)) {
  std::vector<Vec3> first_nodes;
  for (const Piece& piece : pieces) {
    first_nodes.push_back(piece.nodes.front().at);
    largest_spacing = std::max(largest_spacing, piece.spacing());
  }
  starts = spatial::KdTree(first_nodes);
}

/// A wedge seen from the axis of a circle: the same all around it.
ChainNode seen_from_axis(const Fit& circle, const ChainNode& node) {
  const Vec3 tangent = tangent_at(circle, node.at), outward = tangent.cross(circle.direction);
  const auto turned = [&](const Vec3& side) {
    return Vec3(side.dot(outward), side.dot(circle.direction), 0.0);
  };
  return {.at = node.at,
          .along = tangent,
          .side_a = turned(node.side_a),
          .side_b = turned(node.side_b)};
}

bool same_wedge(const Fit& circle, const ChainNode& a, const ChainNode& b) {
  const ChainNode x = seen_from_axis(circle, a), y = seen_from_axis(circle, b);
  return match(x.side_a, x.side_b, y.side_a, y.side_b).cosine > 0.6;
}

bool lies_on(const Fit& circle, const Piece& whole, const Piece& piece, double reach) {
  std::size_t on = 0;
  for (const ChainNode& node : piece.nodes) {
    const Vec3 nearest = nearest_on(circle, node.at);
    on += (nearest - node.at).norm() < reach * node.spacing &&
          std::abs(tangent_at(circle, node.at).dot(node.along)) > 0.8 &&
          same_wedge(circle, whole.middle(), node);
  }
  return 5 * on >= 4 * piece.nodes.size();
}

double angle_at(const Fit& circle, const Vec3& x, const Vec3& place) {
  const Vec3 y = circle.direction.cross(x), offset = place - circle.point;
  return std::atan2(y.dot(offset), x.dot(offset));
}

struct Gap {
  Vec3 from, to;
  double length;
};

/// The gaps between nodes sorted about the axis.
std::vector<Gap> sort_about_axis(const Fit& circle, std::vector<ChainNode>& nodes) {
  const Vec3 x = circle.direction.unitOrthogonal();
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    order.emplace_back(angle_at(circle, x, nodes[i].at), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<ChainNode> sorted;
  for (const auto& [angle, i] : order) {
    ChainNode node = nodes[i];
    if (tangent_at(circle, node.at).dot(node.along) < 0.0) node.along = -node.along;
    sorted.push_back(node);
  }
  nodes = std::move(sorted);
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t next = (i + 1) % nodes.size();
    double angle = order[next].first - order[i].first;
    if (next == 0) angle += kWholeTurn;
    const double length = angle * circle.radius;
    if (length > 2.5 * nodes[i].spacing) gaps.push_back({nodes[i].at, nodes[next].at, length});
  }
  return gaps;
}

/// Whether an end of another long piece is where a gap begins.
bool is_blocked(const std::vector<Gap>& gaps, const std::vector<Piece>& pieces, const Index& index,
                const std::vector<std::size_t>& joined) {
  std::vector<spatial::Neighbour> near;
  for (const Gap& gap : gaps) {
    for (const Vec3& place : {gap.from, gap.to}) {
      index.open.tree.within_unsorted(place, kBlocking * index.largest_spacing, near);
      for (const auto& end : near) {
        const auto [j, side] = index.open.ends[end.index];
        const Piece& other = pieces[j];
        if (other.closed || other.nodes.size() < kLeastArc) continue;
        if (std::binary_search(joined.begin(), joined.end(), j)) continue;
        if ((other.ends[side] - place).norm() < kBlocking * other.spacing()) return true;
      }
    }
  }
  return false;
}

/// The pieces on the circle of `arc`, itself among them, in their order.
std::vector<std::size_t> pieces_on_circle(const std::vector<Piece>& pieces, const Index& index,
                                          std::size_t arc, double reach) {
  const Piece& whole = pieces[arc];
  std::vector<spatial::Neighbour> near;
  index.starts.within_unsorted(whole.fit.point, whole.fit.radius + 3.0 * whole.spacing(), near);
  std::vector<std::size_t> found = {arc};
  for (const auto& start : near) {
    const std::size_t j = start.index;
    if (j == arc || pieces[j].closed) continue;
    if (lies_on(whole.fit, whole, pieces[j], reach)) found.push_back(j);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The circle that `arc` is of, with all pieces on it (`joined`); nothing if it is not to be
/// closed.
std::optional<Piece> completed(const std::vector<Piece>& pieces, const Index& index,
                               std::size_t arc, double tolerance,
                               std::vector<std::size_t>& joined) {
  Piece whole = pieces[arc];
  joined = pieces_on_circle(pieces, index, arc, 3.0 * tolerance);
  for (const std::size_t j : joined) {
    if (j == arc) continue;
    whole.nodes.insert(whole.nodes.end(), pieces[j].nodes.begin(), pieces[j].nodes.end());
  }
  const Fit fit = fit_arc(whole.nodes);
  if (fit.kind != CurveKind::kArc || fit.error > 2.0 * tolerance) return std::nullopt;
  whole.fit = fit;
  const std::vector<Gap> gaps = sort_about_axis(fit, whole.nodes);
  double open = 0.0;
  for (const Gap& gap : gaps) open += gap.length;
  if (open > kMostOpen * kWholeTurn * fit.radius) return std::nullopt;
  if (is_blocked(gaps, pieces, index, joined)) return std::nullopt;
  whole.closed = true;
  whole.ends = {whole.nodes.front().at, whole.nodes.front().at};
  return whole;
}

}  // namespace

void complete_circles(std::vector<Piece>& pieces, double tolerance) {
  const Index index(pieces);
  std::vector<std::uint8_t> gone(pieces.size(), 0);
  std::vector<std::size_t> joined;
  for (const std::size_t i : longest_first(pieces)) {
    const Piece& piece = pieces[i];
    if (gone[i] || piece.closed || piece.fit.kind != CurveKind::kArc) continue;
    if (piece.nodes.size() < kLeastArc || piece.fit.radius < kSmallestRadius * piece.spacing()) {
      continue;
    }
    auto circle = completed(pieces, index, i, tolerance, joined);
    if (!circle) continue;
    for (const std::size_t j : joined) {
      if (j == i) continue;
      gone[j] = 1;
      pieces[j].closed = true;  // not to be joined again
    }
    pieces[i] = std::move(*circle);
  }
  erase_marked(pieces, gone);
}

}  // namespace pcednet::lines
