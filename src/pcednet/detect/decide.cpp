#include "pcednet/detect/decide.h"

#include <algorithm>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::detect {
namespace {

/// Writes the network's answer for one point.
void decide_point(std::span<const float> probabilities, const std::vector<std::uint8_t>& classes,
                  std::size_t point, Classification& found) {
  float sharp = 0.0f, smooth = 0.0f;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (classes[c] == kSharpEdge) sharp = probabilities[c];
    if (classes[c] == kSmoothEdge) smooth = probabilities[c];
  }
  found.p_sharp[point] = sharp;
  found.p_smooth[point] = smooth;
  const bool edge = sharp + smooth > 0.5f;
  found.classes[point] = !edge ? kNonEdge : sharp >= smooth ? kSharpEdge : kSmoothEdge;
}

}  // namespace

Classification nothing_found(std::size_t points) {
  return {.classes = std::vector<std::uint8_t>(points, kUnlabelled),
          .p_sharp = std::vector<float>(points, 0.0f),
          .p_smooth = std::vector<float>(points, 0.0f)};
}

void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const std::vector<std::uint8_t>& classes, Classification& found) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    decide_point(probabilities.subspan(i * classes.size(), classes.size()), classes, points[i],
                 found);
  }
}

ClassCounts count_classes(const std::vector<std::uint8_t>& classes) {
  const auto count = [&](std::uint8_t wanted) {
    return static_cast<std::size_t>(std::count(classes.begin(), classes.end(), wanted));
  };
  return {count(kNonEdge), count(kSmoothEdge), count(kSharpEdge), count(kBoundary),
          count(kUnlabelled)};
}

}  // namespace pcednet::detect
