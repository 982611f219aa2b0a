#include "pcednet/normals/orient.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/outward.h"
#include "pcednet/normals/sign_votes.h"

namespace pcednet::normals {
namespace {

void check(const OrientOptions& options) {
  if (options.neighbours < 1) {
    throw Error(ErrorKind::kUsage,
                fmt::format("orientation needs at least 1 neighbour, not {}", options.neighbours));
  }
  if (options.viewpoint && !options.viewpoint->allFinite()) {
    throw Error(ErrorKind::kUsage, "the viewpoint is not finite");
  }
}

/// Below zero if the vector points downwards; to the back or the left if it is horizontal.
bool points_down(const Vec3& v) {
  for (const int axis : {2, 1, 0}) {
    if (v[axis] != 0.0) return v[axis] < 0.0;
  }
  return false;
}

void face_viewpoint(std::span<const Vec3> points, std::span<Vec3> normals, const Vec3& viewpoint) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double facing = normals[i].dot(viewpoint - points[i]);
    if (facing < 0.0 || (facing == 0.0 && points_down(normals[i]))) normals[i] = -normals[i];
  }
}

/// Turns one connected surface outwards, or upwards; returns whether outwards could be decided.
bool turn_outwards(std::span<const Vec3> points, std::span<Vec3> normals,
                   std::span<const std::uint32_t> members) {
  const double outward = outwardness(points, normals, members);
  bool turn = outward < 0.0;
  const bool decided = std::abs(outward) >= kDecided;
  if (!decided) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t i : members) sum += normals[i];
    turn = points_down(sum);
  }
  if (turn) {
    for (const std::uint32_t i : members) normals[i] = -normals[i];
  }
  return decided;
}

Orientation turn_parts_outwards(std::span<const Vec3> points, std::span<Vec3> normals,
                                const Signs& signs) {
  std::vector<std::size_t> first(signs.parts + 1, 0);
  for (const std::uint32_t part : signs.part) ++first[part + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> members(points.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) members[next[signs.part[i]]++] = i;

  Orientation orientation;
  for (std::size_t part = 0; part < signs.parts; ++part) {
    const std::span<const std::uint32_t> of_part(members.data() + first[part],
                                                 first[part + 1] - first[part]);
    if (normals[of_part.front()].isZero(0.0)) continue;
    ++orientation.components;
    if (!turn_outwards(points, normals, of_part)) ++orientation.undecided;
  }
  return orientation;
}

}  // namespace

Orientation orient_normals(const NeighbourGraph& graph, std::span<Vec3> normals,
                           const OrientOptions& options, const Progress* progress) {
  check(options);
  if (options.viewpoint) {
    face_viewpoint(graph.points, normals, *options.viewpoint);
    return {};
  }
  Stage stage(progress, "orientation", 4);
  const Adjacency links = make_adjacency(graph, static_cast<std::size_t>(options.neighbours));
  stage.advance();
  const SignVotes votes{graph.points, normals, links};
  Signs signs = contract(votes);
  stage.advance();
  turn_outvoted_points(votes, signs.sign);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (signs.sign[i] < 0) normals[i] = -normals[i];
  }
  stage.advance();
  const Orientation orientation = turn_parts_outwards(graph.points, normals, signs);
  stage.advance();
  return orientation;
}

Orientation orient_normals(std::span<const Vec3> positions, std::span<Vec3> normals,
                           const OrientOptions& options, const Progress* progress) {
  check(options);
  if (normals.size() != positions.size()) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} normals for {} positions", normals.size(), positions.size()));
  }
  if (options.viewpoint) {
    face_viewpoint(positions, normals, *options.viewpoint);
    return {};
  }
  const NeighbourGraph graph =
      make_neighbour_graph(positions, static_cast<std::size_t>(options.neighbours), progress);
  std::vector<Vec3> of_points(graph.points.size(), Vec3::Zero());
  for (std::size_t i = positions.size(); i-- > 0;) {
    if (graph.point_of[i] != kNoPoint) of_points[graph.point_of[i]] = normals[i];
  }
  const Orientation orientation = orient_normals(graph, of_points, options, progress);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (graph.point_of[i] == kNoPoint) continue;
    if (normals[i].dot(of_points[graph.point_of[i]]) < 0.0) normals[i] = -normals[i];
  }
  return orientation;
}

}  // namespace pcednet::normals
