#include "pcednet/lines/crease.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/lanes.h"
#include "pcednet/lines/local_planes.h"
#include "pcednet/lines/noisy_wedge.h"
#include "pcednet/lines/ordered_points.h"
#include "pcednet/lines/plane_wedge.h"

namespace pcednet::lines {
namespace {

/// Nearest points that are tried with an edge point, itself among them: bands of smooth-edge are
/// wide enough, sharp-edge may be a single row.
constexpr std::size_t kWithSharp = 9, kWithSmooth = 3;

/// In much noise wedges are fitted to all points around, from this many down: the fewer, the less
/// of other edges is among them.
constexpr std::size_t kNoisyNeighbours[] = {80, 56, 40, 28};
constexpr double kNoiseOfPlanes = 1.2;  ///< measured noise is too low: planes of few points bend

/// Where one side of an edge is much denser than the other, the nearest points are all of the
/// denser: so many are looked at then, thinned to a distance from each other, in that of the last.
constexpr std::size_t kFarNeighbours = 300;
constexpr double kApart = 0.16;
constexpr std::size_t kUnevenSides = 3;  ///< times as many points
constexpr double kAlmostAll = 0.95;
constexpr double kOffSide = 0.5, kReachesLine = 0.5;  ///< spacings

/// Of points to be tried beside those of an edge class; the second is added per spacing of noise.
constexpr double kLeastProbability[] = {0.1, 0.9};

/// Mean squares of the normals across an edge at least, and along it as a share of that at most.
constexpr double kLeastVaried = 0.04, kMostAlong = 0.15;
constexpr double kShortened = 8.0 / 9.0;  ///< the share of squared lengths that does not count

/// Ends of the zones of a side: near the line, between, far; in spacings.
constexpr double kNearZone[] = {0.15, 0.9}, kMiddleZone = 1.9, kFarZone = 3.3;

struct Tolerances {
  WedgeTolerances wedge;
  std::size_t points;     ///< around an edge point
  bool skips_other_side;  ///< of these, those that face away: beyond a thin wall
};

/// Sums of heights over the points of a side that are near the line, beyond and far from it.
struct ZoneSums {
  double height[3], count[3];
};

PCEDNET_VECTOR_CLONES
ZoneSums sum_zones(const Vec3& at, const Vec3& along, const Vec3& side, const Vec3& inward,
                   const NearPoints& points, double most_height) {
  const double ends[4] = {kNearZone[0], kNearZone[1], kMiddleZone, kFarZone};
  const double at_x = at.x(), at_y = at.y(), at_z = at.z();
  const double along_x = along.x(), along_y = along.y(), along_z = along.z();
  const double side_x = side.x(), side_y = side.y(), side_z = side.z();
  const double up_x = inward.x(), up_y = inward.y(), up_z = inward.z();
  Lanes heights[3] = {}, counts[3] = {};
  Lanes number = {0.0, 1.0, 2.0, 3.0};
  const Lanes zero = {}, one = zero + 1.0;
  const auto count = static_cast<double>(points.count);
  for (std::size_t i = 0; i < points.count; i += kLanes, number += kLanes) {
    Lanes x, y, z;
    load(&points.x[i], x);
    load(&points.y[i], y);
    load(&points.z[i], z);
    x -= at_x, y -= at_y, z -= at_z;
    const Lanes lengthwise = x * along_x + y * along_y + z * along_z;
    const Lanes place = x * side_x + y * side_y + z * side_z;
    const Lanes height = x * up_x + y * up_y + z * up_z;
    const auto is_near = (lengthwise <= kSliceAlong) & (lengthwise >= -kSliceAlong) &
                         (height <= most_height) & (height >= -most_height) & (number < count);
    for (int k = 0; k < 3; ++k) {
      const auto in_zone = is_near & (place >= ends[k]) & (place < ends[k + 1]);
      heights[k] += in_zone ? height : zero;
      counts[k] += in_zone ? one : zero;
    }
  }
  ZoneSums sums;
  for (int k = 0; k < 3; ++k) {
    sums.height[k] = sum_of(heights[k]);
    sums.count[k] = sum_of(counts[k]);
  }
  return sums;
}

/// How much the points of a side bend towards the inside of the wedge: their mean distance to the
/// plane near the line and far from it, less that between.
double bend_of(const Vec3& at, const Vec3& along, const Vec3& side, const Vec3& inward,
               const NearPoints& points, double tolerance) {
  const ZoneSums sums = sum_zones(at, along, side, inward, points, tolerance + 0.3);
  if (sums.count[1] == 0.0) return 0.0;
  const double middle = sums.height[1] / sums.count[1];
  double bend = 0.0;
  for (const int zone : {0, 2}) {
    if (sums.count[zone] > 0.0) bend += sums.height[zone] / sums.count[zone] - middle;
  }
  return bend;
}

/// The mean of both sides.
double bend_of(const Wedge& wedge, const NearPoints& points, double tolerance) {
  Vec3 into_a = wedge.along.cross(wedge.side_a), into_b = wedge.along.cross(wedge.side_b);
  if (into_a.dot(wedge.side_b) < 0.0) into_a = -into_a;
  if (into_b.dot(wedge.side_a) < 0.0) into_b = -into_b;
  const double a = bend_of(wedge.at, wedge.along, wedge.side_a, into_a, points, tolerance);
  const double b = bend_of(wedge.at, wedge.along, wedge.side_b, into_b, points, tolerance);
  return 0.5 * (a + b);
}

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
      if (cloud.cosine(i, near.index) < 0.0) continue;
    }
    near_points.add((cloud.position(near.index) - cloud.position(i)) / spacing,
                    cloud.normal(near.index), cloud.probability(near.index));
  }
  const auto wedge = best_wedge(near_points, within);
  if (!wedge) return std::nullopt;
  return Crease{.at = cloud.position(i) + spacing * wedge->at,
                .along = wedge->along,
                .side_a = wedge->side_a,
                .side_b = wedge->side_b,
                .spacing = spacing,
                .probability = cloud.probability(i),
                .bend = static_cast<float>(bend_of(*wedge, near_points, within.wedge.plane)),
                .edge_class = cloud.is_edge(i) ? cloud.edge_class(i) : kNonEdge};
}

using FarRow = std::array<double, kFarNeighbours>;

/// Places, and the squared distance of each to the nearest of those chosen.
struct FarPlaces {
  FarRow x, y, z, sq_nearest;
};

/// For the places from that one on.
PCEDNET_VECTOR_CLONES
void choose(FarPlaces& places, std::size_t chosen, std::size_t count) {
  const double at_x = places.x[chosen], at_y = places.y[chosen], at_z = places.z[chosen];
  for (std::size_t i = chosen; i < count; ++i) {
    const double x = places.x[i] - at_x, y = places.y[i] - at_y, z = places.z[i] - at_z;
    places.sq_nearest[i] = smaller(places.sq_nearest[i], x * x + y * y + z * z);
  }
}

/// Of these, nearest first, those that are not near one chosen before: at most as many as
/// NearPoints has room for beside the point itself.
std::vector<spatial::Neighbour> thinned(const OrderedPoints& cloud,
                                        std::span<const spatial::Neighbour> others) {
  std::vector<spatial::Neighbour> kept;
  if (others.empty()) return kept;
  const double sq_apart = kApart * kApart * others.back().sq_distance;
  FarPlaces places;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const Vec3& place = cloud.position(others[i].index);
    places.x[i] = place.x(), places.y[i] = place.y(), places.z[i] = place.z();
    places.sq_nearest[i] = others.back().sq_distance;
  }
  for (std::size_t i = 0; i < others.size() && kept.size() + 1 < NearPoints::kMost; ++i) {
    if (places.sq_nearest[i] < sq_apart) continue;
    kept.push_back(others[i]);
    choose(places, i, others.size());
  }
  return kept;
}

/// Of these, those that are nearest if lengths along the edge count for a third: as many as
/// NearPoints has room for beside the point itself. The edge runs where the normals do not vary.
/// None if they vary in no direction, or in all.
std::vector<spatial::Neighbour> along_edge(const OrderedPoints& cloud, std::uint32_t point,
                                           std::span<const spatial::Neighbour> others) {
  Mat3 scatter = Mat3::Zero();
  for (const auto& near : others) {
    const Vec3 normal = cloud.normal(near.index);
    scatter += normal * normal.transpose();
  }
  const Eigendecomposition axes = eigendecomposition(scatter / static_cast<double>(others.size()));
  if (axes.values[1] < kLeastVaried || axes.values[0] > kMostAlong * axes.values[1]) return {};
  const Vec3 along = axes.vectors.col(0);
  std::vector<spatial::Neighbour> nearest(others.begin(), others.end());
  for (auto& near : nearest) {
    const double length = (cloud.position(near.index) - cloud.position(point)).dot(along);
    near.sq_distance -= kShortened * length * length;
  }
  const std::size_t count = std::min(nearest.size(), NearPoints::kMost - 1);
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count),
                    nearest.end(), [](const auto& a, const auto& b) {
                      return std::tie(a.sq_distance, a.index) < std::tie(b.sq_distance, b.index);
                    });
  nearest.resize(count);
  return nearest;
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
  const auto faces = [&](const auto& other) { return !(cloud.cosine(point, other.index) < 0.0); };
  return static_cast<std::size_t>(std::count_if(others.begin(), others.end(), faces));
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
