#include "pcednet/lines/pieces/ring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pcednet/lines/curves/curve.h"

namespace pcednet::lines {
namespace {

constexpr double kBlocking = 2.5;  ///< spacings from the end of a piece to a gap
constexpr double kBeside = 1.2;    ///< spacings from a circle to nodes that are of it

// Edge points that follow a circle through a gap.
constexpr double kLeastFollowed = 6.0;  ///< radius, in spacings: edges of small details are near
constexpr double kOnGap = 1.2;          ///< spacings from the circle
constexpr double kLeastOnGap = 0.85;    ///< share of the gaps

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

}  // namespace

PieceIndex::PieceIndex(const std::vector<Piece>& pieces)
    : starts({}), open(pieces, open_ends(pieces)) {
  std::vector<Vec3> first_nodes;
  for (const Piece& piece : pieces) {
    first_nodes.push_back(piece.nodes.front().at);
    largest_spacing = std::max(largest_spacing, piece.spacing());
  }
  starts = spatial::KdTree(first_nodes);
}

bool same_wedge(const Fit& circle, const ChainNode& a, const ChainNode& b) {
  const ChainNode x = seen_from_axis(circle, a), y = seen_from_axis(circle, b);
  return match(x.side_a, x.side_b, y.side_a, y.side_b).cosine > 0.6;
}

Sectors::Sectors(const Fit& circle, std::size_t count)
    : circle_(circle), x_(circle.direction.unitOrthogonal()), seen_(count, 0) {}

double Sectors::add(const Vec3& place) {
  const double angle = angle_at(circle_, x_, place), turn = angle / kWholeTurn + 0.5;
  const auto sector = static_cast<std::size_t>(turn * static_cast<double>(seen_.size()));
  seen_[std::min(sector, seen_.size() - 1)] = 1;
  ++points_;
  return angle;
}

std::size_t Sectors::covered() const {
  return static_cast<std::size_t>(std::count(seen_.begin(), seen_.end(), 1));
}

double widest_gap(std::vector<double>& angles) {
  std::sort(angles.begin(), angles.end());
  double widest = kWholeTurn - (angles.back() - angles.front());
  for (std::size_t i = 1; i < angles.size(); ++i) {
    widest = std::max(widest, angles[i] - angles[i - 1]);
  }
  return widest;
}

bool belongs_to(const Fit& circle, const Piece& piece) {
  std::size_t beside = 0;
  for (const ChainNode& node : piece.nodes) {
    const Eigen::Vector2d place = about_axis(circle, node.at);
    beside += std::abs(place.y()) < kBeside * node.spacing &&
              place.x() - circle.radius < kBeside * node.spacing;
  }
  return 5 * beside >= 3 * piece.nodes.size();
}

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

bool edges_follow(const Fit& circle, const std::vector<Gap>& gaps, double spacing,
                  const OrderedPoints& cloud) {
  if (circle.radius < kLeastFollowed * spacing) return false;
  std::vector<spatial::Neighbour> near;
  std::size_t steps = 0, on = 0;
  for (const Gap& gap : gaps) {
    const Vec3 x = (nearest_on(circle, gap.from) - circle.point).normalized();
    const Vec3 y = circle.direction.cross(x);
    const auto parts = static_cast<std::size_t>(gap.length / spacing);
    for (std::size_t i = 1; i < parts; ++i) {
      const double along = gap.length * static_cast<double>(i) / static_cast<double>(parts);
      const double angle = along / circle.radius;
      const Vec3 out = std::cos(angle) * x + std::sin(angle) * y;
      cloud.within(circle.point + circle.radius * out, kOnGap * spacing, near);
      ++steps;
      on += std::any_of(near.begin(), near.end(),
                        [&](const auto& point) { return cloud.is_edge(point.index); });
    }
  }
  return static_cast<double>(on) >= kLeastOnGap * static_cast<double>(steps);
}

bool is_blocked(const std::vector<Gap>& gaps, const std::vector<Piece>& pieces,
                const PieceIndex& index, const std::vector<std::size_t>& joined) {
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

}  // namespace pcednet::lines
