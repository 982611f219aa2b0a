#include "pcednet/normals/orient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcednet/core/error.h"
#include "pcednet/core/half_space.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/outward.h"
#include "pcednet/normals/sign_votes.h"
#include "pcednet/spatial/kd_tree.h"

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

/// Flips `normal`, or not. Either way no zero keeps a minus sign, which would reveal its former
/// direction.
void turn(Vec3& normal, bool about) {
  normal = (about ? Vec3(-normal) : normal) + Vec3::Zero();
}

void face(const Vec3& point, Vec3& normal, const Vec3& viewpoint) {
  const double facing = normal.dot(viewpoint - point);
  turn(normal, facing < 0.0 || (facing == 0.0 && points_down(normal)));
}

/// Orients one connected surface outwards, or upwards; returns whether outwards could be decided.
bool turn_outwards(std::span<const Vec3> points, std::span<Vec3> normals,
                   std::span<const std::uint32_t> members) {
  const double outward = outwardness(points, normals, members);
  bool inward = outward < 0.0;
  const bool decided = std::abs(outward) >= kDecided;
  if (!decided) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t i : members) sum += normals[i];
    inward = points_down(sum);
  }
  if (inward) {
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

/// The number of points with another sign than most of their part, among those whose normals are
/// nearly parallel to those of most neighbours: the sign of other normals is meaningless.
std::size_t count_minorities(const Signs& signs, std::span<const Vec3> normals,
                             const Adjacency& links) {
  constexpr double kAlong = 0.9;
  std::vector<std::uint8_t> is_along(normals.size());
  parallel_for_each(normals.size(), [&](std::size_t i) {
    std::size_t along = 0;
    for (const auto& row : links.of(i)) {
      for (const std::uint32_t j : row) along += std::abs(normals[i].dot(normals[j])) > kAlong;
    }
    is_along[i] = 2 * along > links.degree(i);
  });
  std::vector<std::size_t> sizes(signs.parts, 0), turned(signs.parts, 0);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    sizes[signs.part[i]] += is_along[i];
    turned[signs.part[i]] += is_along[i] && signs.sign[i] < 0;
  }
  std::size_t sum = 0;
  for (std::size_t part = 0; part < signs.parts; ++part) {
    sum += std::min(turned[part], sizes[part] - turned[part]);
  }
  return sum;
}

/// For each point of the graph the first normal, of those of its copies, that is not zero.
std::vector<Vec3> first_normals(const NeighbourGraph& graph, std::span<const Vec3> normals) {
  const std::vector<std::uint32_t>& order = graph.order;
  const auto point_at = [&](std::size_t i) { return graph.point_of[order[i]]; };
  std::vector<Vec3> first(graph.points.size());
  parallel_for_each(order.size(), [&](std::size_t i) {
    const std::uint32_t point = point_at(i);
    if (i > 0 && point_at(i - 1) == point) return;
    Vec3 normal = normals[order[i]];
    while (normal.isZero(0.0) && ++i < order.size() && point_at(i) == point) {
      normal = normals[order[i]];
    }
    first[point] = normal;
  });
  return first;
}

/// How a normal lies among those of its neighbours.
struct Opposition {
  bool any = false;   ///< a neighbour is more than 90 degrees from it
  bool most = false;  ///< they are in the mean, by how well they are seen
};

Opposition opposition(std::uint32_t point, std::span<const spatial::Neighbour> near,
                      std::span<const Vec3> normals, std::span<const float> seen) {
  constexpr double kBack = -0.95;   // cosine to a normal on the other side of a wall
  constexpr double kOpposed = 0.1;  // mean cosine
  Opposition found;
  double sum = 0.0, weights = 0.0;
  for (const spatial::Neighbour& other : near) {
    const double cosine = normals[point].dot(normals[other.index]);
    if (other.index == point || cosine < kBack) continue;
    const double weight = static_cast<double>(seen[other.index]);
    found.any = found.any || cosine < 0.0;
    sum += weight * cosine;
    weights += weight;
  }
  found.most = sum < -kOpposed * weights;
  return found;
}

/// See face_scanners(); the normals face them.
void settle_slanted(std::span<const Vec3> positions, std::span<Vec3> normals,
                    std::span<const Vec3> scanners) {
  constexpr double kSlanted = 0.7;  // cosine to the beam
  constexpr std::size_t kBeside = 12;
  constexpr int kSettlings = 4;
  std::vector<float> seen(positions.size(), 0.0f);
  std::vector<std::uint32_t> doubtful;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const Vec3 beam = scanners[i] - positions[i];
    if (!beam.allFinite() || beam.isZero(0.0)) continue;
    seen[i] = static_cast<float>(std::abs(normals[i].dot(beam.normalized())));
    if (seen[i] < kSlanted) doubtful.push_back(i);
  }
  if (doubtful.empty()) return;
  const spatial::KdTree tree(positions);
  for (int round = 0; round < kSettlings && !doubtful.empty(); ++round) {
    std::vector<Opposition> found(doubtful.size());
    parallel_blocks(doubtful.size(), 256, [&](std::size_t begin, std::size_t end) {
      std::vector<spatial::Neighbour> near;
      for (std::size_t k = begin; k < end; ++k) {
        tree.nearest(positions[doubtful[k]], kBeside + 1, near);
        found[k] = opposition(doubtful[k], near, normals, seen);
      }
    });
    std::size_t left = 0;
    for (std::size_t k = 0; k < doubtful.size(); ++k) {
      if (found[k].most) turn(normals[doubtful[k]], true);
      if (found[k].any) doubtful[left++] = doubtful[k];
    }
    doubtful.resize(left);
  }
}

}  // namespace

void check_size(std::string_view what, std::size_t count, std::size_t positions) {
  if (count == positions) return;
  throw Error(ErrorKind::kUsage, fmt::format("{} {} for {} positions", count, what, positions));
}

std::size_t face_viewpoints(std::span<const Vec3> positions, std::span<Vec3> normals,
                            std::span<const Vec3> viewpoints) {
  check_size("normals", normals.size(), positions.size());
  check_size("viewpoints", viewpoints.size(), positions.size());
  std::size_t faced = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!viewpoints[i].allFinite()) continue;
    face(positions[i], normals[i], viewpoints[i]);
    ++faced;
  }
  return faced;
}

std::size_t face_scanners(std::span<const Vec3> positions, std::span<Vec3> normals,
                          std::span<const Vec3> scanners) {
  const std::size_t faced = face_viewpoints(positions, normals, scanners);
  settle_slanted(positions, normals, scanners);
  return faced;
}

Orientation orient_points(const NeighbourGraph& graph, std::span<Vec3> normals,
                          const OrientOptions& options, const Progress* progress) {
  check(options);
  if (options.viewpoint) {
    parallel_for_each(normals.size(), [&](std::size_t i) {
      face(graph.points[i], normals[i], *options.viewpoint);
    });
    return {};
  }
  Stage stage(progress, "orientation", 4);
  const Adjacency links =
      make_adjacency(graph, static_cast<std::size_t>(options.neighbours), progress);
  stage.advance();
  const SignVotes votes(graph.points, normals, links);
  Signs signs = contract(votes, progress);
  stage.advance();
  turn_outvoted_points(votes, signs.sign);
  parallel_for_each(normals.size(), [&](std::size_t i) {
    if (signs.sign[i] < 0) normals[i] = -normals[i];
  });
  stage.advance();
  Orientation orientation = turn_parts_outwards(graph.points, normals, signs);
  if (options.count_turned) orientation.turned = count_minorities(signs, normals, links);
  stage.advance();
  return orientation;
}

Orientation orient_normals(const NeighbourGraph& graph, std::span<const Vec3> positions,
                           std::span<Vec3> normals, const OrientOptions& options,
                           const Progress* progress) {
  check(options);
  check_size("normals", normals.size(), positions.size());
  if (options.viewpoint) {
    parallel_for_each(positions.size(),
                      [&](std::size_t i) { face(positions[i], normals[i], *options.viewpoint); });
    return {};
  }
  std::vector<Vec3> of_points = first_normals(graph, normals);
  const Orientation orientation = orient_points(graph, of_points, options, progress);
  parallel_for_each(positions.size(), [&](std::size_t i) {
    if (graph.point_of[i] == kNoPoint) return;
    turn(normals[i], normals[i].dot(of_points[graph.point_of[i]]) < 0.0);
  });
  return orientation;
}

Orientation orient_normals(std::span<const Vec3> positions, std::span<Vec3> normals,
                           const OrientOptions& options, const Progress* progress) {
  check(options);
  check_size("normals", normals.size(), positions.size());
  const std::size_t count = options.viewpoint ? 1 : static_cast<std::size_t>(options.neighbours);
  const NeighbourGraph graph = make_neighbour_graph(positions, NeighbourChoice{count}, progress);
  return orient_normals(graph, positions, normals, options, progress);
}

}  // namespace pcednet::normals
