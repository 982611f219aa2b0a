#include "pcednet/lines/pieces/strings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "pcednet/lines/curves/split.h"
#include "pcednet/lines/curves/turning_points.h"
#include "pcednet/lines/pieces/corners.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLong = 7;  ///< nodes
/// A polyline that is divided has the first, its parts the second.
constexpr std::size_t kLeastNodesDivided = 8, kLeastNodesOfPart = 3;
// Between pieces that end free in noise, in spacings.
constexpr double kAsideInNoise = 2.0;
constexpr double kOverlapInNoise = 6.0;

/// Whether pieces that continue each other are two: an exact arc is what it seems, and a straight
/// and a round piece, if both are long.
bool stay_apart(const Piece& a, const Piece& b) {
  if (is_exact_arc(a) || is_exact_arc(b)) return true;
  const bool both_long = a.nodes.size() >= kLong && b.nodes.size() >= kLong;
  return both_long && (a.fit.kind == CurveKind::kSegment) != (b.fit.kind == CurveKind::kSegment);
}

struct Link {
  std::size_t a, b;  ///< ends
  double cost;
};

struct Reach {
  double gap;
  double cosine;       ///< least, of the directions
  double aside = 0.7;  ///< spacings
  double overlap = 2.0;
  bool kinds_stay_apart = true;
};

/// How well end b continues end a, 0 the best; nothing if it does not.
std::optional<double> cost_of_joint(const Piece& a, std::size_t side_a, const Piece& b,
                                    std::size_t side_b, const Reach& reach) {
  if (a.fit.kind == CurveKind::kPolyline && b.fit.kind == CurveKind::kPolyline &&
      a.nodes.size() < 3 && b.nodes.size() < 3) {
    return std::nullopt;
  }
  if (reach.kinds_stay_apart && stay_apart(a, b)) return std::nullopt;
  const double spacing = a.spacing();
  const Vec3 out_a = outward(a, side_a), out_b = outward(b, side_b);
  const Vec3 offset = b.ends[side_b] - a.ends[side_a];
  const double ahead = offset.dot(out_a), aside = (offset - ahead * out_a).norm();
  if (out_a.dot(-out_b) < reach.cosine || ahead < -reach.overlap * spacing) return std::nullopt;
  const double most_aside = reach.aside * spacing + 0.2 * std::abs(ahead);
  if (offset.norm() > reach.gap || aside > most_aside) return std::nullopt;
  if (!same_wedge(node_at(a, side_a), node_at(b, side_b))) return std::nullopt;
  return (offset.norm() + 2.0 * aside) / spacing + 4.0 * (1.0 - out_a.dot(-out_b));
}

/// Pairs of `ends` that continue each other, the best first.
std::vector<Link> links_between(std::vector<End> ends, const std::vector<Piece>& pieces,
                                const Reach& reach) {
  const EndIndex index(pieces, std::move(ends));
  std::vector<Link> links;
  std::vector<spatial::Neighbour> near;
  for (std::size_t e = 0; e < index.ends.size(); ++e) {
    index.tree.within(index.places[e], reach.gap, near);
    for (const auto& other : near) {
      const End &a = index.ends[e], &b = index.ends[other.index];
      if (other.index <= e || a.piece == b.piece) continue;
      const auto cost = cost_of_joint(pieces[a.piece], a.side, pieces[b.piece], b.side, reach);
      if (cost) links.push_back({2 * a.piece + a.side, 2 * b.piece + b.side, *cost});
    }
  }
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& a, const Link& b) { return a.cost < b.cost; });
  return links;
}

/// Nodes of the piece from its end `side` on, moved onto its curve.
void append_nodes(const Piece& piece, std::size_t side, std::vector<ChainNode>& nodes) {
  const std::size_t count = piece.nodes.size();
  for (std::size_t i = 0; i < count; ++i) {
    ChainNode node = piece.nodes[side == 0 ? i : count - 1 - i];
    if (piece.fit.kind != CurveKind::kPolyline) {
      node.at = nearest_on(piece.fit, node.at);
      node.along = along_at(piece.fit, node, node.at);
    }
    if (side != 0) node.along = -node.along;
    if (!nodes.empty() && (node.at - nodes.back().at).dot(nodes.back().along) <= 0.0) continue;
    nodes.push_back(node);
  }
}

/// Makes polylines of the linked pieces.
void string_along(const std::vector<Link>& links, std::vector<Piece>& pieces) {
  std::vector<std::size_t> partner(2 * pieces.size(), kNoPartner);
  for (const Link& link : links) {
    if (partner[link.a] != kNoPartner || partner[link.b] != kNoPartner) continue;
    partner[link.a] = link.b;
    partner[link.b] = link.a;
  }
  std::vector<Piece> result;
  for (const auto& [entries, closed] : follow_partners(partner)) {
    if (entries.size() == 1) {
      result.push_back(std::move(pieces[entries[0] / 2]));
      continue;
    }
    Piece string{.fit = {}, .nodes = {}, .ends = {}};
    for (const std::size_t entry : entries) {
      append_nodes(pieces[entry / 2], entry % 2, string.nodes);
    }
    string.closed = closed && string.nodes.size() > 4;
    string.ends = {string.nodes.front().at, string.nodes.back().at};
    result.push_back(std::move(string));
  }
  pieces = std::move(result);
}

/// The segments and arcs, at most `most`, that explain all nodes of a polyline; none if they do
/// not.
std::vector<Piece> parts_of(const Piece& piece, double tolerance, std::size_t most,
                            const Progress* progress) {
  if (piece.fit.kind != CurveKind::kPolyline || is_boundary(piece.middle()) ||
      piece.nodes.size() < kLeastNodesDivided) {
    return {};
  }
  const Chain chain = {.nodes = piece.nodes, .closed = piece.closed};
  const std::vector<Run> runs = split(chain, tolerance, progress);
  const auto is_part = [](const Run& run) {
    return run.fit.kind != CurveKind::kPolyline && run.last - run.first >= kLeastNodesOfPart;
  };
  const bool explained = runs.size() <= most && std::all_of(runs.begin(), runs.end(), is_part);
  return explained ? pieces_of(chain, runs, kLeastNodesOfPart) : std::vector<Piece>();
}

}  // namespace

std::vector<EndString> follow_partners(std::span<const std::size_t> partner) {
  std::vector<EndString> strings;
  std::vector<std::uint8_t> done(partner.size() / 2, 0);
  const auto follow = [&](std::size_t entry) {
    EndString string;
    do {
      done[entry / 2] = 1;
      string.entries.push_back(entry);
      entry = partner[entry ^ 1U];
    } while (entry != kNoPartner && !done[entry / 2]);
    string.closed = entry != kNoPartner;
    strings.push_back(std::move(string));
  };
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (done[i]) continue;
    if (partner[2 * i] == kNoPartner) {
      follow(2 * i);
    } else if (partner[2 * i + 1] == kNoPartner) {
      follow(2 * i + 1);
    }
  }
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (!done[i]) follow(2 * i);
  }
  return strings;
}

void string_together(std::vector<Piece>& pieces, double gap, double angle) {
  string_along(links_between(open_ends(pieces), pieces, {gap, std::cos(angle)}), pieces);
}

void divide_strings(std::vector<Piece>& pieces, double tolerance, std::size_t most,
                    const Progress* progress) {
  std::vector<Piece> result;
  for (Piece& piece : pieces) {
    std::vector<Piece> parts = parts_of(piece, tolerance, most, progress);
    if (parts.empty()) parts.push_back(std::move(piece));
    std::move(parts.begin(), parts.end(), std::back_inserter(result));
  }
  pieces = std::move(result);
}

void string_free_ends(std::vector<Piece>& pieces, double gap, double angle, double noise) {
  const Reach reach = {gap, std::cos(angle), kAsideInNoise, kOverlapInNoise, false};
  string_along(links_between(free_ends(pieces, noise), pieces, reach), pieces);
}

std::vector<Vec3> simplified(const std::vector<Vec3>& places, double tolerance) {
  if (places.size() < 3) return places;
  std::vector<Vec3> vertices;
  for (const std::size_t i : turning_points(std::span(places), tolerance)) {
    vertices.push_back(places[i]);
  }
  return vertices;
}

}  // namespace pcednet::lines
