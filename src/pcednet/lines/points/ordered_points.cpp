#include "pcednet/lines/points/ordered_points.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pcednet/core/sort_unique.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/side_of_square.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kSpacingNeighbours = 15;

/// Beyond these no prediction has the class: above one half, but for the last digit of a text, a
/// point is predicted as an edge, and one in ten is less than the best of eight classes has.
constexpr float kMostOfNonEdge = 0.501f, kLeastOfEdge = 0.1f;

/// The probability of an edge; 0 without probabilities. A class that it contradicts was corrected,
/// and counts alone.
float probability_of(const EdgePoints& points, std::uint32_t i) {
  if (points.p_sharp.empty()) return 0.0f;
  const float p =
      std::min(1.0f, points.p_sharp[i] + (points.p_smooth.empty() ? 0.0f : points.p_smooth[i]));
  const std::uint8_t its_class = points.classes[i];
  if (its_class == kSharpEdge || its_class == kSmoothEdge) return p < kLeastOfEdge ? 1.0f : p;
  return its_class != kBoundary && p > kMostOfNonEdge ? 0.0f : p;
}

/// Whether point a stands for both at one place: by values, so that numbering does not matter.
bool stands_for(const EdgePoints& points, std::uint32_t a, std::uint32_t b) {
  const float pa = probability_of(points, a), pb = probability_of(points, b);
  if (pa != pb) return pa > pb;
  const auto rank = [&](std::uint32_t i) {
    return points.classes[i] == kUnlabelled ? 0 : points.classes[i] + 1;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  const Vec3 na = upward(points.normals[a]), nb = upward(points.normals[b]);
  const auto is_larger = [](const Vec3& v, const Vec3& w) {
    return std::tie(v.x(), v.y(), v.z()) > std::tie(w.x(), w.y(), w.z());
  };
  if (na != nb || points.scanners.empty()) return is_larger(na, nb);
  return is_larger(points.scanners[a], points.scanners[b]);
}

/// Points at one place follow each other along the curve; one stands for all.
std::vector<std::uint32_t> distinct_points(const EdgePoints& points) {
  std::vector<std::uint32_t> order(points.curve.begin(), points.curve.end());
  if (order.empty()) order = spatial::curve_order(points.positions);
  std::size_t kept = 0;
  for (const std::uint32_t i : order) {
    if (kept == 0 || points.positions[i] != points.positions[order[kept - 1]]) {
      order[kept++] = i;
    } else if (stands_for(points, i, order[kept - 1])) {
      order[kept - 1] = i;
    }
  }
  order.resize(kept);
  return order;
}

std::vector<Vec3> seen_from(const Vec3& origin, std::vector<Vec3> positions) {
  for (Vec3& position : positions) position -= origin;
  return positions;
}

}  // namespace

OrderedPoints::OrderedPoints(const EdgePoints& points, const Vec3& origin)
    : points_(points),
      origin_(origin),
      order_(distinct_points(points)),
      positions_(seen_from(origin, spatial::in_order(points.positions, order_))),
      normals_(spatial::in_order(points.normals, order_)),
      search_(positions_) {}

float OrderedPoints::probability(std::size_t i) const {
  if (points_.p_sharp.empty()) return is_edge(i) ? 1.0f : 0.0f;
  return probability_of(points_, order_[i]);
}

std::vector<std::uint32_t> OrderedPoints::near_any(std::span<const Vec3> places,
                                                   double radius) const {
  std::vector<std::uint32_t> indices;
  std::vector<spatial::Neighbour> near;
  for (const Vec3& place : places) {
    within(place, radius, near);
    for (const auto& point : near) indices.push_back(point.index);
  }
  sort_unique(indices);
  return indices;
}

void OrderedPoints::nearest_others(std::span<const std::uint32_t> points, std::size_t count,
                                   std::vector<spatial::Neighbour>& found) const {
  found.resize(points.size() * available(count));
  search_.nearest_others(points, count, found);
}

double spacing_of(std::span<const spatial::Neighbour> others) {
  const std::size_t count = std::min(others.size(), kSpacingNeighbours);
  if (count == 0) return 0.0;
  return spatial::side_of_square(others[count - 1].sq_distance, count + 1);
}

}  // namespace pcednet::lines
