#include "pcednet/lines/exact_folds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pcednet/core/parallel.h"
#include "pcednet/lines/exact_planes.h"
#include "pcednet/lines/exact_vertices.h"
#include "pcednet/lines/fold_search.h"

namespace pcednet::lines {
namespace {

constexpr double kOnePlaneSine = 0.01;  ///< of planes that are one
constexpr double kOneCurve = 0.9;       ///< cosine of folds that approximate a curve
constexpr double kOneLine = 0.9999;     ///< and of those that are on one line
constexpr double kAlongFold = 0.8;      ///< cosine of a crease
constexpr std::size_t kPointsAtOnce = 512, kPairsAtOnce = 8;
constexpr std::uint32_t kNoPlane = std::numeric_limits<std::uint32_t>::max();

// In spacings.
constexpr double kContactReach = 2.5;
constexpr double kLongFacet = 12.0;  ///< longer ones are edges of a face that bends
constexpr double kOneEnd = 1.5;      ///< of folds that continue each other
constexpr double kExplained = 0.9, kBeyondEnd = 0.5;  ///< of creases from a fold
constexpr double kNodesNear = 1.5;  ///< of a crease: nodes of all folds that may explain it

/// In the order of the planes, then of the points.
std::vector<PlaneContact> contacts_of(const OrderedPoints& cloud,
                                      const std::vector<PlanePatch>& planes, double spacing) {
  std::vector<std::uint32_t> plane_at(cloud.size(), kNoPlane), points;
  for (std::uint32_t p = 0; p < planes.size(); ++p) {
    for (const std::uint32_t i : planes[p].members) plane_at[i] = p;
  }
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (plane_at[i] != kNoPlane) points.push_back(i);
  }
  std::vector<std::vector<PlaneContact>> of_blocks((points.size() + kPointsAtOnce - 1) /
                                                   kPointsAtOnce);
  parallel_blocks(points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    std::vector<std::uint32_t> others;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t own = plane_at[points[k]];
      cloud.within(cloud.position(points[k]), kContactReach * spacing, near);
      others.clear();
      for (const auto& other : near) {
        const std::uint32_t plane = plane_at[other.index];
        if (plane != own && plane != kNoPlane) others.push_back(plane);
      }
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
      for (const std::uint32_t other : others) {
        of_blocks[begin / kPointsAtOnce].push_back(
            {std::min(own, other), std::max(own, other), points[k]});
      }
    }
  });
  std::vector<PlaneContact> contacts;
  for (const auto& block : of_blocks) contacts.insert(contacts.end(), block.begin(), block.end());
  std::sort(contacts.begin(), contacts.end(),
            [](const PlaneContact& a, const PlaneContact& b) { return a.key() < b.key(); });
  return contacts;
}

std::vector<std::span<const PlaneContact>> by_planes(const std::vector<PlaneContact>& contacts) {
  std::vector<std::span<const PlaneContact>> pairs;
  for (std::size_t begin = 0, end = 0; begin < contacts.size(); begin = end) {
    while (end < contacts.size() && contacts[end].planes() == contacts[begin].planes()) ++end;
    pairs.push_back(std::span(contacts).subspan(begin, end - begin));
  }
  return pairs;
}

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

}  // namespace

std::vector<Piece> find_exact_folds(const OrderedPoints& cloud, double spacing,
                                    const Progress* progress) {
  const std::vector<PlanePatch> planes = find_exact_planes(cloud, spacing, progress);
  const std::vector<PlaneContact> contacts = contacts_of(cloud, planes, spacing);
  const auto pairs = by_planes(contacts);
  const PlaneNeighbours neighbours(planes.size(), pairs);
  const std::vector<std::uint8_t> is_facet = facets_of(planes, pairs);
  std::vector<std::vector<Piece>> of_pairs(pairs.size());
  Stage stage(progress, "exact folds", pairs.size());
  parallel_blocks(pairs.size(), kPairsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto [a, b, point] = pairs[k].front();
      const auto line = fold_line(planes[a], planes[b], cloud.position(point));
      if (!line) continue;
      const FoldSearch search(cloud, planes[a], planes[b], *line, spacing);
      of_pairs[k] = search.folds(pairs[k]);
      if (is_facet[a] || is_facet[b]) continue;
      const std::vector<Vec3> vertices =
          vertices_of(cloud, planes, pairs[k], neighbours.of_both(a, b), spacing);
      const std::vector<Piece> between = search.folds_between(vertices, of_pairs[k]);
      of_pairs[k].insert(of_pairs[k].end(), between.begin(), between.end());
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
  std::vector<Piece> found;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    if (!is_part[i]) found.push_back(std::move(folds[i].piece));
  }
  return found;
}

void erase_explained(std::vector<Crease>& creases, const std::vector<Piece>& folds) {
  if (folds.empty()) return;
  const NodeIndex index(folds);
  const auto explains = [](const Piece& fold, const Crease& crease) {
    const double along = (crease.at - fold.ends[0]).dot(fold.fit.direction);
    const double beyond = kBeyondEnd * crease.spacing;
    return std::abs(fold.fit.direction.dot(crease.along)) > kAlongFold && along > -beyond &&
           along < length_of(fold) + beyond &&
           (nearest_on(fold.fit, crease.at) - crease.at).norm() < kExplained * crease.spacing;
  };
  std::vector<spatial::Neighbour> near;
  std::erase_if(creases, [&](const Crease& crease) {
    index.tree.within_unsorted(crease.at, kNodesNear * crease.spacing, near);
    return std::any_of(near.begin(), near.end(), [&](const auto& node) {
      return explains(folds[index.piece[node.index]], crease);
    });
  });
}

}  // namespace pcednet::lines
