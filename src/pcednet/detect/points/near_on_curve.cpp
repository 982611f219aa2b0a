#include "pcednet/detect/points/near_on_curve.h"

#include <algorithm>

#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {

std::vector<std::uint32_t> nearest_on_curve(std::span<const Vec3> positions,
                                            std::span<const std::uint32_t> places,
                                            std::size_t place, std::size_t around,
                                            std::size_t count) {
  const Vec3& centre = positions[places[place]];
  const auto sq_distance = [&](std::uint32_t point) {
    return (positions[point] - centre).squaredNorm();
  };
  std::vector<std::uint32_t> near;
  const std::size_t begin = place - std::min(place, around);
  for (std::size_t k = begin; k < std::min(place + around, places.size()); ++k) {
    if (k != place) near.push_back(places[k]);
  }
  count = std::min(count, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                    [&](auto a, auto b) { return sq_distance(a) < sq_distance(b); });
  near.resize(count);
  return near;
}

NearOnCurve near_on_curve(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                          std::size_t near) {
  const std::size_t around = 8 * near / 3;
  NearOnCurve found;
  found.near = near;
  const std::vector<std::uint32_t> places = spatial::firsts_of_places(positions, curve);
  const std::size_t samples = std::min(NearOnCurve::kSamples, places.size());
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t i = s * places.size() / samples;
    const auto nearest = nearest_on_curve(positions, places, i, around, near);
    if (nearest.size() < near) continue;
    found.points.push_back(places[i]);
    found.neighbours.insert(found.neighbours.end(), nearest.begin(), nearest.end());
  }
  return found;
}

}  // namespace pcednet::detect
