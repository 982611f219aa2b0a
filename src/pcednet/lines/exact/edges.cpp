#include "pcednet/lines/exact/edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "pcednet/core/parallel.h"
#include "pcednet/lines/exact/contacts.h"
#include "pcednet/lines/exact/cylinder_ends.h"
#include "pcednet/lines/exact/cylinder_folds.h"
#include "pcednet/lines/exact/cylinders.h"
#include "pcednet/lines/exact/fold_search.h"
#include "pcednet/lines/exact/planes.h"
#include "pcednet/lines/exact/vertices.h"

namespace pcednet::lines {
namespace {

constexpr double kOnePlaneSine = 0.01;  ///< of planes that are one
constexpr double kOneCurve = 0.9;       ///< cosine of folds that approximate a curve
constexpr double kOneLine = 0.9999;     ///< and of those that are on one line
constexpr double kAlongEdge = 0.8;      ///< cosine of a crease
constexpr double kMostlySharp = 0.5;    ///< share of the edge points along a fillet
constexpr std::size_t kPairsAtOnce = 8;

// In spacings.
constexpr double kLongFacet = 12.0;  ///< longer ones are edges of a face that bends
constexpr double kOneEnd = 1.5;      ///< of folds that continue each other
constexpr double kExplainedWithin = 0.9, kBeyondEnd = 0.5;  ///< of creases from an edge
constexpr double kNodesNear = 1.5;  ///< of a crease: nodes of edges that may explain it

/// A segment where two planes meet.
struct ExactFold {
  Piece piece;
  std::uint32_t a, b;  ///< its planes
};

/// Marks the planes beside others that are turned little: facets of a curved surface.
std::vector<std::uint8_t> facets_of(const std::vector<PlanePatch>& planes,
                                    const std::vector<std::span<const PlaneContact>>& pairs) {
  std::vector<std::uint8_t> is_facet(planes.size(), 0);
  for (const auto& contacts : pairs) {
    const auto [a, b, point] = contacts.front();
    const double sine = planes[a].normal.cross(planes[b].normal).norm();
    if (sine > kOnePlaneSine && sine < kLeastSineOfFold) is_facet[a] = is_facet[b] = 1;
  }
  return is_facet;
}

/// Marks the folds of one plane that continue each other and turn little: they are of a curve.
std::vector<std::uint8_t> parts_of_curves(const std::vector<ExactFold>& folds, double spacing) {
  std::vector<Piece> pieces;
  for (const ExactFold& fold : folds) pieces.push_back(fold.piece);
  const EndIndex index(pieces, open_ends(pieces));
  std::vector<std::uint8_t> is_part(folds.size(), 0);
  std::vector<spatial::Neighbour> near;
  for (std::size_t k = 0; k < index.ends.size(); ++k) {
    const ExactFold& fold = folds[index.ends[k].piece];
    index.tree.within_unsorted(index.places[k], kOneEnd * spacing, near);
    for (const auto& end : near) {
      const ExactFold& other = folds[index.ends[end.index].piece];
      const int shared =
          (fold.a == other.a) + (fold.a == other.b) + (fold.b == other.a) + (fold.b == other.b);
      const double cosine = std::abs(fold.piece.fit.direction.dot(other.piece.fit.direction));
      if (shared != 1 || cosine < kOneCurve || cosine > kOneLine) continue;
      is_part[index.ends[k].piece] = 1;
    }
  }
  return is_part;
}

/// The segments where planes meet, and the fillets between them.
ExactEdges find_folds(const OrderedPoints& cloud, const std::vector<PlanePatch>& planes,
                      const std::vector<std::span<const PlaneContact>>& pairs, double spacing,
                      const Progress* progress) {
  const PlaneNeighbours neighbours(planes.size(), pairs);
  const std::vector<std::uint8_t> is_facet = facets_of(planes, pairs);
  std::vector<std::vector<Piece>> of_pairs(pairs.size()), rounded(pairs.size());
  Stage stage(progress, "exact folds", pairs.size());
  parallel_blocks(pairs.size(), kPairsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto [a, b, point] = pairs[k].front();
      const auto line = fold_line(planes[a], planes[b], cloud.position(point));
      if (!line) continue;
      const FoldSearch search(cloud, surface_of(planes[a]), surface_of(planes[b]), *line, spacing);
      of_pairs[k] = search.folds(pairs[k]);
      rounded[k] = search.fillets(pairs[k]);
      std::erase_if(of_pairs[k],
                    [&](const Piece& fold) { return search.is_rounded(fold, rounded[k]); });
      if (is_facet[a] || is_facet[b]) continue;
      const std::vector<Vec3> vertices =
          vertices_of(cloud, planes, pairs[k], neighbours.of_both(a, b), spacing);
      std::vector<Piece> known = of_pairs[k];
      append(known, rounded[k]);
      append(of_pairs[k], search.folds_between(vertices, known));
    }
    stage.advance(end - begin);
  });
  std::vector<ExactFold> folds;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [a, b, point] = pairs[k].front();
    for (Piece& piece : of_pairs[k]) {
      const bool is_short = length_of(piece) < kLongFacet * spacing;
      if ((is_facet[a] || is_facet[b]) && is_short) continue;
      folds.push_back({std::move(piece), a, b});
    }
  }
  const std::vector<std::uint8_t> is_part = parts_of_curves(folds, spacing);
  ExactEdges found;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    if (!is_part[i]) found.pieces.push_back(std::move(folds[i].piece));
  }
  for (std::vector<Piece>& of_pair : rounded) append(found.rounded, std::move(of_pair));
  return found;
}

/// The cylinders among the free points near each plane, and across it.
std::vector<ExactCylinder> find_cylinders(
    const OrderedPoints& cloud, const std::vector<PlanePatch>& planes,
    const std::vector<std::span<const PlaneContact>>& free_points, double spacing,
    const Progress* progress) {
  std::vector<std::vector<ExactCylinder>> of_planes(free_points.size());
  Stage stage(progress, "exact cylinders", free_points.size());
  parallel_blocks(free_points.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::vector<std::uint32_t> points;
      for (const PlaneContact& contact : free_points[k]) points.push_back(contact.point);
      of_planes[k] =
          find_exact_cylinders(cloud, planes[free_points[k].front().a], points, spacing, progress);
    }
    stage.advance(end - begin);
  });
  std::vector<ExactCylinder> cylinders;
  for (auto& of_plane : of_planes) std::ranges::move(of_plane, std::back_inserter(cylinders));
  return cylinders;
}

/// The arcs where the cylinders meet the planes that they are across.
ExactEdges find_arcs(const OrderedPoints& cloud, const std::vector<ExactCylinder>& cylinders,
                     double spacing, const Progress* progress) {
  std::vector<ExactEdges> of_cylinders(cylinders.size());
  Stage stage(progress, "exact arcs", cylinders.size());
  parallel_blocks(cylinders.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      of_cylinders[k] = edges_of_cylinder(Profile(cloud, cylinders[k], spacing));
    }
    stage.advance(end - begin);
  });
  ExactEdges found;
  for (ExactEdges& of_cylinder : of_cylinders) append(found, std::move(of_cylinder));
  return found;
}

/// How far along a piece a place on its line or circle is, from its first end.
double along(const Piece& piece, const Vec3& place) {
  if (piece.fit.kind == CurveKind::kSegment) {
    return (place - piece.ends[0]).dot(piece.fit.direction);
  }
  const Vec3& centre = piece.fit.point;
  const auto turn = [&](const Vec3& to) {
    return turn_about(piece.fit.direction, piece.ends[0] - centre, to - centre);
  };
  double angle = turn(place);
  const double opposite = 0.5 * (turn(piece.ends[1]) + kWholeTurn);
  if (!piece.closed && angle > opposite) angle -= kWholeTurn;
  return angle * piece.fit.radius;
}

}  // namespace

ExactEdges find_exact_edges(const OrderedPoints& cloud, double spacing, const Progress* progress) {
  const std::vector<PlanePatch> planes = find_exact_planes(cloud, spacing, progress);
  const std::vector<PlaneContact> contacts = contacts_of(cloud, planes, spacing, progress);
  const ContactPairs pairs = by_planes(contacts);
  const std::vector<ExactCylinder> cylinders =
      find_cylinders(cloud, planes, pairs.of_free_points, spacing, progress);
  ExactEdges edges = find_arcs(cloud, cylinders, spacing, progress);
  append(edges.pieces,
         find_cylinder_folds(cloud, planes, cylinders, pairs.of_free_points, spacing, progress));
  append(edges, find_folds(cloud, planes, pairs.of_planes, spacing, progress));
  return edges;
}

void keep_labelled(ExactEdges& edges, const OrderedPoints& cloud) {
  if (cloud.has_probabilities()) return;
  for (Piece& piece : edges.rounded) {
    double sharp = 0.0;
    for (const ChainNode& node : piece.nodes) sharp += node.sharp;
    piece.rounded = sharp < kMostlySharp * static_cast<double>(piece.nodes.size());
    if (!piece.rounded) edges.pieces.push_back(piece);
  }
  std::erase_if(edges.rounded, [](const Piece& piece) { return !piece.rounded; });
}

void erase_explained(std::vector<Crease>& creases, const ExactEdges& edges) {
  std::vector<Piece> all = edges.pieces;
  append(all, edges.rounded);
  append(all, edges.cut_off);
  if (all.empty()) return;
  const NodeIndex index(all);
  double step = 0.0;  // from node to node
  for (const Piece& edge : all) step = std::max(step, edge.spacing());
  const auto explains = [](const Piece& edge, const Crease& crease) {
    const Vec3 nearest = nearest_on(edge.fit, crease.at);
    const double at = along(edge, nearest), beyond = kBeyondEnd * crease.spacing;
    return std::abs(tangent_at(edge.fit, nearest).dot(crease.along)) > kAlongEdge &&
           (edge.closed || (at > -beyond && at < length_of(edge) + beyond)) &&
           (nearest - crease.at).norm() < kExplainedWithin * crease.spacing;
  };
  std::vector<spatial::Neighbour> near;
  std::erase_if(creases, [&](const Crease& crease) {
    index.tree.within_unsorted(crease.at, kNodesNear * std::max(crease.spacing, step), near);
    return std::any_of(near.begin(), near.end(), [&](const auto& node) {
      return explains(all[index.piece[node.index]], crease);
    });
  });
}

}  // namespace pcednet::lines
