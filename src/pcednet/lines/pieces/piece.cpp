#include "pcednet/lines/pieces/piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "pcednet/core/half_space.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::lines {
namespace {

constexpr double kOneWedge = 0.7;            ///< least cosine of sides
constexpr double kFacing = 0.5;              ///< least cosine of the ends of joined pieces
constexpr double kSameDirectionTwice = 0.7;  ///< of an edge and its copy
constexpr std::size_t kPiecesAtOnce = 64;    ///< between two looks at the progress
constexpr double kOnExact = 0.1;             ///< spacings from one line to another that is the same
constexpr double kBesideExact = 0.8;         ///< of copies of an exact one
constexpr double kOneExact = 0.15;           ///< spacings between exact copies, across
constexpr double kOneExactStep = 0.8;        ///< and between their nodes
constexpr double kDuplicate = 1.2;           ///< spacings between copies of one edge

void set_ends(Piece& piece) {
  const ChainNode &first = piece.nodes.front(), &last = piece.nodes.back();
  if (piece.fit.kind == CurveKind::kPolyline) {
    piece.ends = {first.at, last.at};
    return;
  }
  // Creases reach half a node beyond the means of the first and the last.
  piece.ends = {nearest_on(piece.fit, first.at - 0.4 * first.spacing * first.along),
                nearest_on(piece.fit, last.at + 0.4 * last.spacing * last.along)};
}

double arc_angle(const Piece& piece) {
  return turn_about(piece.fit.direction, piece.ends[0] - piece.fit.point,
                    piece.ends[1] - piece.fit.point);
}

/// Whether nodes run against the direction of the line, or about the axis of the circle clockwise.
bool run_backward(const Fit& fit, const std::vector<ChainNode>& nodes) {
  if (fit.kind == CurveKind::kSegment) {
    return fit.direction.dot(nodes.back().at - nodes.front().at) < 0.0;
  }
  double turn = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    turn += fit.direction.dot((nodes[i - 1].at - fit.point).cross(nodes[i].at - fit.point));
  }
  return turn < 0.0;
}

/// Both as one on the line or circle of the exact one, if the other is on it.
std::optional<Piece> joined_on_exact(const Piece& a, const Piece& b, Piece both, double tolerance) {
  const bool a_rules = a.exact && (!b.exact || a.nodes.size() >= b.nodes.size());
  const Piece &ruler = a_rules ? a : b, &other = a_rules ? b : a;
  const bool of_one_kind = other.fit.kind == ruler.fit.kind;
  if (!of_one_kind && (other.exact || ruler.fit.kind == CurveKind::kSegment)) return std::nullopt;
  const double most = other.exact ? kOnExact : tolerance;
  double sum = 0.0;
  for (const ChainNode& node : other.nodes) {
    sum += (nearest_on(ruler.fit, node.at) - node.at).squaredNorm() / (node.spacing * node.spacing);
  }
  if (sum > most * most * static_cast<double>(other.nodes.size())) return std::nullopt;
  both.fit = ruler.fit;
  if (run_backward(both.fit, both.nodes)) both.fit.direction = -both.fit.direction;
  both.exact = true;
  set_ends(both);
  return both;
}

/// Both as one, from a's other end to b's; nothing if no segment or arc fits them together.
std::optional<Piece> joined(const Piece& a, std::size_t side_a, const Piece& b, std::size_t side_b,
                            double tolerance) {
  Piece both{.fit = {}, .nodes = {}, .ends = {}};
  both.nodes.reserve(a.nodes.size() + b.nodes.size());
  append(both.nodes, a.nodes, side_a == 1);
  append(both.nodes, b.nodes, side_b == 0);
  if (a.exact || b.exact) return joined_on_exact(a, b, std::move(both), tolerance);
  const bool straight = a.fit.kind == CurveKind::kSegment && b.fit.kind == CurveKind::kSegment;
  both.fit = straight ? fit_segment(both.nodes) : fit_arc(both.nodes);
  const double within = tolerance_at(node_at(a, side_a), tolerance);
  const double limit = std::max({1.4 * within, 1.3 * a.fit.error, 1.3 * b.fit.error});
  if (both.fit.kind == CurveKind::kPolyline || both.fit.error > limit) return std::nullopt;
  set_ends(both);
  return both;
}

/// The direction of the node at an end of the piece, out of it.
Vec3 out_of(const Piece& piece, std::size_t side) {
  return side == 1 ? piece.nodes.back().along : Vec3(-piece.nodes.front().along);
}

/// Whether b may begin where a ends.
bool may_continue(const Piece& a, std::size_t side_a, const Piece& b, std::size_t side_b,
                  double gap) {
  const ChainNode &end = node_at(a, side_a), &start = node_at(b, side_b);
  const Vec3 offset = start.at - end.at, out = out_of(a, side_a);
  return offset.norm() <= std::max(gap, 2.0 * end.spacing) &&
         -out.dot(out_of(b, side_b)) >= kFacing && offset.dot(out) >= -1.5 * end.spacing &&
         same_wedge(end, start);
}

/// Both as one, joined at the first pair of ends that allows it.
std::optional<Piece> try_ways(const Piece& a, const Piece& b, double gap, double tolerance) {
  constexpr std::array<std::array<std::size_t, 2>, 3> kWays = {{{1, 0}, {1, 1}, {0, 0}}};
  for (const auto& [side_a, side_b] : kWays) {
    if (!may_continue(a, side_a, b, side_b, gap)) continue;
    if (auto both = joined(a, side_a, b, side_b, tolerance)) return both;
  }
  if (!may_continue(b, 1, a, 0, gap)) return std::nullopt;
  return joined(b, 1, a, 0, tolerance);
}

std::vector<Vec3> ends_of(const std::vector<Piece>& pieces) {
  std::vector<Vec3> places;
  for (const Piece& piece : pieces) {
    places.push_back(piece.nodes.front().at);
    places.push_back(piece.nodes.back().at);
  }
  return places;
}

/// One pass of joins; true if there was one.
bool join_once(std::vector<Piece>& pieces, double gap, double tolerance, const Progress* progress) {
  const spatial::KdTree tree(ends_of(pieces));
  std::vector<std::uint8_t> gone(pieces.size(), 0), changed(pieces.size(), 0);
  std::vector<spatial::Neighbour> near;
  bool any = false;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i % kPiecesAtOnce == 0) throw_if_cancelled(progress);
    if (gone[i] || changed[i] || pieces[i].closed || pieces[i].fit.kind == CurveKind::kPolyline) {
      continue;
    }
    for (const std::size_t side : {0, 1}) {
      const Vec3 place = side == 0 ? pieces[i].nodes.front().at : pieces[i].nodes.back().at;
      tree.within(place, std::max(gap, 2.0 * pieces[i].spacing()), near);
      for (const auto& other : near) {
        const std::size_t j = other.index / 2;
        if (j == i || gone[j] || changed[j] || pieces[j].closed) continue;
        if (pieces[j].fit.kind == CurveKind::kPolyline) continue;
        auto both = try_ways(pieces[i], pieces[j], gap, tolerance);
        if (!both) continue;
        pieces[i] = std::move(*both);
        changed[i] = gone[j] = 1;
        any = true;
        break;
      }
      if (changed[i]) break;
    }
  }
  erase_marked(pieces, gone);
  return any;
}

/// Arcs whose ends are nearly at the same place become circles.
void close_circles(std::vector<Piece>& pieces, double gap) {
  for (Piece& piece : pieces) {
    if (piece.closed || piece.fit.kind != CurveKind::kArc) continue;
    const double angle = arc_angle(piece);
    const double open = (kWholeTurn - angle) * piece.fit.radius;
    const double turn = 1.5 * std::numbers::pi;
    if (angle > turn && open < gap) piece.closed = true;
  }
}

/// Drops the pieces most of whose nodes are beside nodes of longer ones that are kept, or of exact
/// ones.
void drop_beside(std::vector<Piece>& pieces, bool exact_alone) {
  const NodeIndex index(pieces);
  std::vector<std::uint8_t> dropped(pieces.size(), 0), kept(pieces.size(), 0);
  std::vector<spatial::Neighbour> near;
  for (std::size_t i = 0; i < pieces.size(); ++i) kept[i] = pieces[i].exact;
  for (const std::size_t i : longest_first(pieces)) {
    if (pieces[i].exact) continue;
    std::size_t covered = 0;
    for (const ChainNode& node : pieces[i].nodes) {
      index.tree.within_unsorted(node.at, kDuplicate * node.spacing, near);
      covered += std::any_of(near.begin(), near.end(), [&](const auto& other) {
        const ChainNode& of_other = *index.nodes[other.index];
        const std::size_t j = index.piece[other.index];
        if (!kept[j] || std::abs(of_other.along.dot(node.along)) < kSameDirectionTwice) {
          return false;
        }
        return !pieces[j].exact || same_wedge(of_other, node) ||
               (of_other.at - node.at).norm() < kBesideExact * node.spacing;
      });
    }
    dropped[i] = 2 * covered > pieces[i].nodes.size();
    kept[i] = !dropped[i] && !exact_alone;
  }
  erase_marked(pieces, dropped);
}

void drop_duplicates(std::vector<Piece>& pieces) {
  drop_beside(pieces, false);
}

}  // namespace

void append(std::vector<ChainNode>& nodes, const std::vector<ChainNode>& more, bool in_order) {
  if (in_order) {
    nodes.insert(nodes.end(), more.begin(), more.end());
    return;
  }
  for (auto node = more.rbegin(); node != more.rend(); ++node) {
    nodes.push_back(*node);
    nodes.back().along = -node->along;
  }
}

Vec3 along_at(const Fit& fit, const ChainNode& node, const Vec3& place) {
  if (fit.kind == CurveKind::kPolyline) return node.along;
  const Vec3 tangent = tangent_at(fit, place);
  return turned_to(tangent, node.along);
}

Vec3 outward(const Piece& piece, std::size_t side) {
  const Vec3 along = along_at(piece.fit, node_at(piece, side), piece.ends[side]);
  return side == 0 ? Vec3(-along) : along;
}

bool same_wedge(const ChainNode& a, const ChainNode& b) {
  return match(a.side_a, a.side_b, b.side_a, b.side_b).cosine > kOneWedge;
}

std::vector<End> open_ends(const std::vector<Piece>& pieces) {
  std::vector<End> ends;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].closed) continue;
    ends.push_back({i, 0});
    ends.push_back({i, 1});
  }
  return ends;
}

EndIndex::EndIndex(const std::vector<Piece>& pieces, std::vector<End> of_these)
    : ends(std::move(of_these)), tree({}) {
  for (const auto& [piece, side] : ends) places.push_back(pieces[piece].ends[side]);
  tree = spatial::KdTree(places);
}

NodeIndex::NodeIndex(const std::vector<Piece>& pieces) : tree({}) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const ChainNode& node : pieces[i].nodes) {
      nodes.push_back(&node);
      piece.push_back(i);
      places.push_back(node.at);
    }
  }
  tree = spatial::KdTree(places);
}

std::vector<std::size_t> longest_first(const std::vector<Piece>& pieces) {
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return pieces[a].nodes.size() > pieces[b].nodes.size();
  });
  return order;
}

void erase_marked(std::vector<Piece>& pieces, const std::vector<std::uint8_t>& marks) {
  std::size_t i = 0;
  std::erase_if(pieces, [&](const Piece&) { return marks[i++] != 0; });
}

double length_of(const Piece& piece) {
  switch (piece.fit.kind) {
    case CurveKind::kSegment:
      return (piece.ends[1] - piece.ends[0]).norm();
    case CurveKind::kArc:
      return piece.fit.radius * (piece.closed ? kWholeTurn : arc_angle(piece));
    default:
      break;
  }
  double length = 0.0;
  for (std::size_t i = 1; i < piece.nodes.size(); ++i) {
    length += (piece.nodes[i].at - piece.nodes[i - 1].at).norm();
  }
  return length;
}

std::vector<Piece> pieces_of(const Chain& chain, const std::vector<Run>& runs,
                             std::size_t least_nodes) {
  std::vector<Piece> pieces;
  const std::size_t count = chain.nodes.size();
  for (const Run& run : runs) {
    if (run.last - run.first < least_nodes) continue;
    Piece piece{.fit = run.fit, .nodes = {}, .ends = {}};
    for (std::size_t i = run.first; i < run.last; ++i) {
      piece.nodes.push_back(chain.nodes[i % count]);
    }
    piece.closed = chain.closed && runs.size() == 1;
    set_ends(piece);
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::optional<Piece> joined_at(const Piece& a, std::size_t side_a, const Piece& b,
                               std::size_t side_b, double tolerance) {
  const Vec3 &end = a.ends[side_a], &start = b.ends[side_b];
  const Vec3 out = outward(a, side_a), on = -outward(b, side_b);
  if (out.dot(on) < kFacing) return std::nullopt;
  const double back = std::min((start - end).dot(out), (start - end).dot(on));
  if (back < -a.spacing()) return std::nullopt;
  return joined(a, side_a, b, side_b, tolerance);
}

void drop_exact_copies(std::vector<Piece>& pieces) {
  const NodeIndex index(pieces);
  std::vector<std::uint8_t> is_copy(pieces.size(), 0), kept(pieces.size(), 0);
  std::vector<spatial::Neighbour> near;
  for (const std::size_t i : longest_first(pieces)) {
    const auto is_on_kept = [&](const ChainNode& node) {
      index.tree.within_unsorted(node.at, kOneExactStep * node.spacing, near);
      return std::any_of(near.begin(), near.end(), [&](const auto& other) {
        const ChainNode& on = *index.nodes[other.index];
        const double aside = (node.at - on.at).cross(on.along).norm();
        return kept[index.piece[other.index]] && aside < kOneExact * node.spacing &&
               std::abs(on.along.dot(node.along)) > kSameDirectionTwice && same_wedge(on, node);
      });
    };
    const auto& nodes = pieces[i].nodes;
    const auto covered =
        static_cast<std::size_t>(std::count_if(nodes.begin(), nodes.end(), is_on_kept));
    is_copy[i] = 3 * covered >= 2 * nodes.size();
    kept[i] = !is_copy[i];
  }
  erase_marked(pieces, is_copy);
}

void drop_beside_exact(std::vector<Piece>& pieces) {
  drop_beside(pieces, true);
}

void join_pieces(std::vector<Piece>& pieces, double gap, double tolerance,
                 const Progress* progress) {
  drop_duplicates(pieces);
  while (join_once(pieces, gap, tolerance, progress)) {
  }
  close_circles(pieces, gap);
  drop_duplicates(pieces);
}

}  // namespace pcednet::lines
