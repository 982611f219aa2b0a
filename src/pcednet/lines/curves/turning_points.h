#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace pcednet::lines {

/// The vertices of a polyline between which all others are within `tolerance` of the chord, and
/// its ends, in order (Douglas and Peucker 1973). `vertices` are two or more vectors of Eigen.
template <typename Vector>
std::vector<std::size_t> turning_points(std::span<const Vector> vertices, double tolerance) {
  std::vector<std::size_t> kept = {0};
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, vertices.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vector chord = (vertices[last] - vertices[first]).stableNormalized();
    double farthest = tolerance;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Vector offset = vertices[i] - vertices[first];
      const double distance = (offset - offset.dot(chord) * chord).norm();
      if (distance > farthest) farthest = distance, split = i;
    }
    if (split == first) {
      kept.push_back(last);
    } else {
      open.push_back({split, last});
      open.push_back({first, split});
    }
  }
  return kept;
}

}  // namespace pcednet::lines
