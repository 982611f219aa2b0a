#include "pcednet/lines/creases/crease.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <utility>

#include "pcednet/lines/creases/bend.h"
#include "pcednet/lines/creases/far_neighbours.h"
#include "pcednet/lines/creases/noisy_wedge.h"
#include "pcednet/lines/creases/plane_wedge.h"
#include "pcednet/lines/points/local_planes.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {
namespace {

/// Nearest points that are tried with an edge point, itself among them: bands of smooth-edge are
/// wide enough, sharp-edge may be a single row.
constexpr std::size_t kWithSharp = 9, kWithSmooth = 3;

/// In much noise wedges are fitted to all points around, from this many down: the fewer, the less
/// of other edges is among them.
constexpr std::size_t kNoisyNeighbours[] = {80, 56, 40, 28};
constexpr double kNoiseOfPlanes = 1.2;  ///< measured noise is too low: planes of few points bend

constexpr std::size_t kUnevenSides = 3;  ///< times as many points
constexpr double kAlmostAll = 0.95;
constexpr double kFlat = 0.995;                       ///< cosine between normals of a flat face
constexpr std::size_t kLeastOnFace = 8;               ///< points of either face of an acute edge
constexpr double kOffSide = 0.5, kReachesLine = 0.5;  ///< spacings

/// Points of no edge class are tried from this probability on; the second is added per spacing of
/// noise.
constexpr double kLeastProbability[] = {0.1, 0.9};

struct Tolerances {
  WedgeTolerances wedge;
  std::size_t points;     ///< around an edge point
  bool skips_other_side;  ///< of these, those that face away: beyond a thin wall
};

std::optional<Wedge> noisy_wedge(const NearPoints& points, double noise) {
  for (const std::size_t count : kNoisyNeighbours) {
    auto wedge = fit_half_planes(points, count, kNoiseOfPlanes * noise);
    if (wedge) return wedge;
  }
  return std::nullopt;
}

/// In noise one of all points, otherwise the best wedge of all pairs of planes.
std::optional<Wedge> best_wedge(const NearPoints& points, const Tolerances& within) {
  if (within.wedge.noise > kMuchNoise) {
    if (auto wedge = noisy_wedge(points, within.wedge.noise)) return wedge;
  }
  return best_plane_wedge(points, within.wedge);
}

std::optional<Crease> crease_at(const OrderedPoints& cloud, std::uint32_t i,
                                std::span<const spatial::Neighbour> others,
                                const Tolerances& within, double spacing) {
  if (!(spacing > 0.0)) return std::nullopt;
  NearPoints near_points;
  near_points.add(Vec3::Zero(), cloud.normal(i), cloud.probability(i));
  for (const auto& near : others) {
    if (within.skips_other_side) {
      if (near_points.count == within.points) break;
      if (cloud.face_away(i, near.index)) continue;
    }
    near_points.add((cloud.position(near.index) - cloud.position(i)) / spacing,
                    cloud.normal(near.index), cloud.probability(near.index));
  }
  const auto wedge = best_wedge(near_points, within);
  if (!wedge) return std::nullopt;
  const double noise = within.wedge.noise;
  const bool tells_smooth = noise >= kExactNoise && noise <= kMuchNoise;
  return Crease{.at = cloud.position(i) + spacing * wedge->at,
                .along = wedge->along,
                .side_a = wedge->side_a,
                .side_b = wedge->side_b,
                .spacing = spacing,
                .probability = cloud.probability(i),
                .bend = static_cast<float>(bend_of(*wedge, near_points, within.wedge.plane)),
                .edge_class = cloud.is_edge(i) ? cloud.edge_class(i) : kNonEdge,
                .rounded = tells_smooth && is_smooth(near_points, *wedge, noise)};
}

/// Whether the points around a crease explain why the nearest of them did not show it: they reach
/// it, and one side has several times the points of the other, or both sides, which are in rows,
/// have almost all of them.
bool is_uneven(const Crease& crease, const OrderedPoints& cloud,
               std::span<const spatial::Neighbour> others) {
  std::size_t counts[2] = {0, 0};
  double nearest = kSideReach;
  const Vec3 sides[2] = {crease.side_a, crease.side_b};
  const Vec3 normals[2] = {crease.along.cross(sides[0]), crease.along.cross(sides[1])};
  for (const auto& near : others) {
    const Vec3 offset = (cloud.position(near.index) - crease.at) / crease.spacing;
    for (int k = 0; k < 2; ++k) {
      const double away = offset.dot(sides[k]);
      if (away <= 0.0 || std::abs(offset.dot(normals[k])) > kOffSide) continue;
      nearest = std::min(nearest, away);
      ++counts[k];
      break;
    }
  }
  if (nearest > kReachesLine) return false;
  const auto [least, most] = std::minmax(counts[0], counts[1]);
  if (most >= kUnevenSides * least) return true;
  return crease.edge_class == kSharpEdge &&
         static_cast<double>(least + most) >= kAlmostAll * static_cast<double>(others.size());
}

/// Where one side is much denser than the other.
std::optional<Crease> uneven_crease(const OrderedPoints& cloud, std::uint32_t point,
                                    std::span<const spatial::Neighbour> others,
                                    const Tolerances& within) {
  const auto even = thinned(cloud, others);
  const auto crease = crease_at(cloud, point, even, within, spacing_of(even));
  return crease && is_uneven(*crease, cloud, others) ? crease : std::nullopt;
}

/// In noise: of points along the edge, which tell more than as many around `point` and reach less
/// far across other edges.
std::optional<Crease> lengthwise_crease(const OrderedPoints& cloud, std::uint32_t point,
                                        std::span<const spatial::Neighbour> others,
                                        const Tolerances& within) {
  const auto along = along_edge(cloud, point, others);
  if (along.empty()) return std::nullopt;
  return crease_at(cloud, point, along, within, spacing_of(others));
}

/// How many of these do not face away from the point.
std::size_t facing(const OrderedPoints& cloud, std::uint32_t point,
                   std::span<const spatial::Neighbour> others) {
  const auto faces = [&](const auto& other) { return !cloud.face_away(point, other.index); };
  return static_cast<std::size_t>(std::count_if(others.begin(), others.end(), faces));
}

/// How many of these are on a flat face with the point.
std::size_t on_face_of(const OrderedPoints& cloud, std::uint32_t point,
                       std::span<const spatial::Neighbour> others) {
  const auto is_on_it = [&](const auto& other) {
    return std::abs(cloud.normal(point).dot(cloud.normal(other.index))) > kFlat;
  };
  return static_cast<std::size_t>(std::count_if(others.begin(), others.end(), is_on_it));
}

/// In noise, at an edge whose faces meet at an acute angle: the other face faces away, but is no
/// other side of a thin wall. Estimated normals, which scatter, do not show it.
std::optional<Crease> acute_crease(const OrderedPoints& cloud, std::uint32_t point,
                                   std::span<const spatial::Neighbour> others, Tolerances within) {
  const auto near = others.first(std::min(others.size(), within.points - 1));
  const auto beside = std::find_if(near.begin(), near.end(), [&](const auto& other) {
    return cloud.face_acutely(point, other.index);
  });
  if (beside == near.end() || on_face_of(cloud, point, near) < kLeastOnFace ||
      on_face_of(cloud, beside->index, near) < kLeastOnFace) {
    return std::nullopt;
  }
  within.skips_other_side = false;
  return crease_at(cloud, point, near, within, spacing_of(near));
}

/// The points of an edge class, those that may be, and the neighbours of both.
std::vector<std::uint32_t> points_near_edges(const OrderedPoints& cloud, double noise,
                                             const Progress* progress) {
  const double least = kLeastProbability[0] + kLeastProbability[1] * noise;
  std::vector<std::uint32_t> edge_points;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (cloud.is_edge(i) || cloud.probability(i) > least) edge_points.push_back(i);
  }
  std::vector<std::uint8_t> chosen(cloud.size(), 0);
  const auto choose = [&](std::uint32_t i) {
    std::atomic_ref(chosen[i]).store(1, std::memory_order_relaxed);
  };
  Stage stage(progress, "edge points", edge_points.size());
  cloud.for_each_neighbourhood(
      edge_points, kWithSharp - 1, stage,
      [&](std::size_t k, std::span<const spatial::Neighbour> others) {
        choose(edge_points[k]);
        const bool sharp = cloud.edge_class(edge_points[k]) == kSharpEdge;
        const std::size_t beside = (sharp ? kWithSharp : kWithSmooth) - 1;
        for (const auto& other : others.first(std::min(others.size(), beside))) choose(other.index);
      });
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (chosen[i]) points.push_back(i);
  }
  return points;
}

/// The creases of the nearest points. Where some of them may face away, a quarter more are
/// searched; few points are beside a thin wall: only they need twice as many, half of them on its
/// other side.
std::vector<std::optional<Crease>> nearest_creases(const OrderedPoints& cloud,
                                                   std::span<const std::uint32_t> points,
                                                   const Tolerances& within,
                                                   const Progress* progress) {
  std::vector<std::uint8_t> is_thin(cloud.size(), 0);
  const auto crease_of = [&](std::uint32_t point, std::span<const spatial::Neighbour> near) {
    return crease_at(cloud, point, near, within, spacing_of(near));
  };
  const std::size_t others = within.points - 1;
  const std::size_t searched = within.skips_other_side ? others + others / 4 : others;
  Stage stage(progress, "creases", points.size());
  std::vector<std::optional<Crease>> found =
      creases_at(cloud, points, searched, stage,
                 [&](std::uint32_t point, std::span<const spatial::Neighbour> near) {
                   is_thin[point] = within.skips_other_side && facing(cloud, point, near) < others;
                   return is_thin[point] ? std::nullopt : crease_of(point, near);
                 });
  std::vector<std::uint32_t> thin;
  std::copy_if(points.begin(), points.end(), std::back_inserter(thin),
               [&](std::uint32_t i) { return is_thin[i] != 0; });
  Stage walls(progress, "creases of thin walls", thin.size());
  const std::vector<std::optional<Crease>> of_thin =
      creases_at(cloud, thin, 2 * others, walls, crease_of);
  for (std::size_t k = 0, next = 0; k < points.size(); ++k) {
    if (is_thin[points[k]]) found[k] = of_thin[next++];
  }
  return found;
}

}  // namespace

std::vector<std::optional<Crease>> creases_at(const OrderedPoints& cloud,
                                              std::span<const std::uint32_t> points,
                                              std::size_t count, Stage& stage,
                                              const CreaseAt& crease_at) {
  std::vector<std::optional<Crease>> found(points.size());
  cloud.for_each_neighbourhood(points, count, stage,
                               [&](std::size_t k, std::span<const spatial::Neighbour> others) {
                                 found[k] = crease_at(points[k], others);
                               });
  return found;
}

void append_found(std::span<const std::optional<Crease>> found, std::vector<Crease>& creases) {
  for (const auto& crease : found) {
    if (crease) creases.push_back(*crease);
  }
}

std::vector<Crease> find_creases(const OrderedPoints& cloud, const Sampling& sampling,
                                 const Progress* progress) {
  const std::vector<std::uint32_t> points = points_near_edges(cloud, sampling.noise, progress);
  const bool noisy = sampling.noise > kMuchNoise;
  const Tolerances within = {.wedge = {.plane = 0.3 + 1.1 * sampling.noise,
                                       .first = 2.0 + 2.0 * sampling.noise,
                                       .noise = sampling.noise},
                             .points = static_cast<std::size_t>(40.0 + 80.0 * sampling.noise),
                             .skips_other_side = noisy && sampling.oriented};
  std::vector<std::optional<Crease>> found = nearest_creases(cloud, points, within, progress);
  std::vector<std::uint32_t> rest;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!found[k] && (noisy || cloud.is_edge(points[k]))) rest.push_back(points[k]);
  }
  Stage again(progress, "creases of more points", rest.size());
  const std::vector<std::optional<Crease>> more =
      creases_at(cloud, rest, kFarNeighbours, again,
                 [&](std::uint32_t point, std::span<const spatial::Neighbour> near) {
                   std::optional<Crease> crease;
                   if (noisy) crease = lengthwise_crease(cloud, point, near, within);
                   if (!crease && within.skips_other_side && cloud.is_edge(point)) {
                     crease = acute_crease(cloud, point, near, within);
                   }
                   if (!crease && cloud.is_edge(point)) {
                     crease = uneven_crease(cloud, point, near, within);
                   }
                   return crease;
                 });
  std::vector<Crease> creases;
  append_found(found, creases);
  append_found(more, creases);
  return creases;
}

}  // namespace pcednet::lines
