#include "workbench/annotate/places.h"

#include <algorithm>
#include <numeric>

namespace pcednet::annotate {

std::vector<std::uint32_t> rank_uncertain(std::span<const Vec3> positions,
                                          const spatial::KdTree& tree,
                                          std::span<const float> confidence, double apart,
                                          std::size_t most) {
  std::vector<std::uint32_t> candidates;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i].allFinite()) candidates.push_back(static_cast<std::uint32_t>(i));
  }
  std::sort(candidates.begin(), candidates.end(), [&](std::uint32_t a, std::uint32_t b) {
    return confidence[a] != confidence[b] ? confidence[a] < confidence[b] : a < b;
  });
  std::vector<std::uint32_t> places;
  std::vector<std::uint8_t> taken(positions.size(), 0);
  std::vector<spatial::Neighbour> found;
  for (const std::uint32_t point : candidates) {
    if (places.size() == most) break;
    if (taken[point]) continue;
    places.push_back(point);
    tree.within_unsorted(positions[point], apart, found);
    for (const auto& [i, sq_distance] : found) taken[i] = 1;
  }
  return places;
}

std::optional<Picked> pick(std::span<const Vec3> positions, const Vec3& origin,
                           const Vec3& direction, double radius) {
  const Vec3 along = direction.normalized();
  std::optional<Picked> first;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 offset = positions[i] - origin;
    const double distance = offset.dot(along);
    if (!(distance >= 0) || (first && distance >= first->distance)) continue;
    if ((offset - distance * along).squaredNorm() <= radius * radius) {
      first = Picked{static_cast<std::uint32_t>(i), distance};
    }
  }
  return first;
}

}  // namespace pcednet::annotate
