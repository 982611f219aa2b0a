#include "pcednet/detect/decide.h"

#include <algorithm>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/nn/predict.h"

namespace pcednet::detect {
namespace {

/// Writes the network's answer for one point.
void decide_point(std::span<const float> probabilities, const std::vector<std::uint8_t>& classes,
                  std::size_t point, Classification& result) {
  std::size_t best = 0;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (probabilities[c] > probabilities[best]) best = c;
    if (classes[c] == kSharpEdge) result.p_sharp[point] = probabilities[c];
    if (classes[c] == kSmoothEdge) result.p_smooth[point] = probabilities[c];
  }
  result.classes[point] = classes[best];
}

}  // namespace

void decide(const nn::Model& network, const std::vector<std::uint8_t>& classes,
            std::span<const float> rows, std::span<const std::uint32_t> targets,
            std::vector<float>& probabilities, Classification& result) {
  probabilities.resize(targets.size() * classes.size());
  nn::predict_into(network, rows, probabilities);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    decide_point(std::span(probabilities).subspan(i * classes.size(), classes.size()), classes,
                 targets[i], result);
  }
}

ClassCounts count_classes(const std::vector<std::uint8_t>& classes) {
  const auto count = [&](std::uint8_t wanted) {
    return static_cast<std::size_t>(std::count(classes.begin(), classes.end(), wanted));
  };
  return {count(kNonEdge), count(kSmoothEdge), count(kSharpEdge), count(kUnlabelled)};
}

}  // namespace pcednet::detect
