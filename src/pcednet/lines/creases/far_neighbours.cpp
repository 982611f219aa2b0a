#include "pcednet/lines/creases/far_neighbours.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/points/local_planes.h"

namespace pcednet::lines {
namespace {

constexpr double kApart = 0.16;  ///< of the points chosen, in the distance of the last

/// Mean squares of the normals across an edge at least, and along it as a share of that at most.
constexpr double kLeastVaried = 0.04, kMostAlong = 0.15;
constexpr double kShortened = 8.0 / 9.0;  ///< the share of squared lengths that does not count

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

}  // namespace

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

}  // namespace pcednet::lines
