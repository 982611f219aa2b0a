#include "pcednet/detect/near_on_curve.h"

#include <algorithm>

#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

/// The nearest to that of place `i`; fewer than kNear if there are not enough.
std::vector<std::uint32_t> nearest_around(std::span<const Vec3> positions,
                                          std::span<const std::uint32_t> places, std::size_t i) {
  constexpr std::size_t kAround = 32;
  const Vec3& centre = positions[places[i]];
  const auto sq_distance = [&](std::uint32_t point) {
    return (positions[point] - centre).squaredNorm();
  };
  std::vector<std::uint32_t> near;
  const std::size_t begin = i - std::min(i, kAround);
  for (std::size_t k = begin; k < std::min(i + kAround, places.size()); ++k) {
    if (k != i) near.push_back(places[k]);
  }
  const std::size_t count = std::min(NearOnCurve::kNear, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                    [&](auto a, auto b) { return sq_distance(a) < sq_distance(b); });
  near.resize(count);
  return near;
}

}  // namespace

NearOnCurve near_on_curve(std::span<const Vec3> positions, std::span<const std::uint32_t> curve) {
  NearOnCurve found;
  const std::vector<std::uint32_t> places = spatial::firsts_of_places(positions, curve);
  const std::size_t samples = std::min(NearOnCurve::kSamples, places.size());
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t i = s * places.size() / samples;
    const auto near = nearest_around(positions, places, i);
    if (near.size() < NearOnCurve::kNear) continue;
    found.points.push_back(places[i]);
    found.neighbours.insert(found.neighbours.end(), near.begin(), near.end());
  }
  return found;
}

}  // namespace pcednet::detect
