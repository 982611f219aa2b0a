#include "pcednet/nn/standardise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/core/parallel.h"

namespace pcednet::nn {
namespace {

constexpr double kTail = 0.005;              // share of the values cut at either end
constexpr std::size_t kMostSamples = 20000;  // of a class

/// Up to kMostSamples of every class, evenly spread over the set: indices per class.
std::vector<std::vector<std::size_t>> pick_samples(std::span<const std::uint8_t> labels) {
  std::array<std::size_t, 256> counts = {};
  for (const std::uint8_t label : labels) ++counts[label];
  std::vector<std::vector<std::size_t>> picked;
  std::array<std::size_t, 256> slot = {};
  for (std::size_t c = 0; c < kIgnoredLabel; ++c) {
    if (counts[c] == 0) continue;
    slot[c] = picked.size();
    picked.emplace_back();
  }
  std::array<std::size_t, 256> seen = {};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::uint8_t label = labels[i];
    if (label == kIgnoredLabel) continue;
    const std::size_t stride = (counts[label] + kMostSamples - 1) / kMostSamples;
    if (seen[label]++ % stride == 0) picked[slot[label]].push_back(i);
  }
  return picked;
}

struct Weighted {
  float value;
  double weight;
};

struct Spread {
  double mean = 0.0, deviation = 0.0;
};

/// Sorts `values`; mean and deviation of them limited to their quantiles kTail and 1 - kTail.
Spread limited_spread(std::vector<Weighted>& values, bool about_zero) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) {
    return a.value < b.value || (a.value == b.value && a.weight < b.weight);
  });
  double total = 0.0;
  for (const Weighted& v : values) total += v.weight;
  double low = values.front().value, high = values.back().value, sum = 0.0;
  bool low_found = false, high_found = false;
  for (const Weighted& v : values) {
    sum += v.weight;
    if (!low_found && sum > kTail * total) low = v.value, low_found = true;
    if (!high_found && sum >= (1.0 - kTail) * total) high = v.value, high_found = true;
  }
  double first = 0.0, second = 0.0;
  for (const Weighted& v : values) {
    const double x = std::clamp<double>(v.value, low, high);
    first += v.weight * x;
    second += v.weight * x * x;
  }
  Spread spread;
  spread.mean = about_zero ? 0.0 : first / total;
  spread.deviation = std::sqrt(std::max(0.0, second / total - spread.mean * spread.mean));
  return spread;
}

}  // namespace

Standardisation no_standardisation(int inputs) {
  const auto n = static_cast<std::size_t>(inputs);
  return {std::vector<float>(n, 0.0f), std::vector<float>(n, 1.0f), 1e6f};
}

Standardisation measure_standardisation(const TrainingSet& set, int scales, int features,
                                        std::span<const std::uint8_t> odd) {
  const auto inputs = static_cast<std::size_t>(scales) * static_cast<std::size_t>(features);
  const auto picked = pick_samples(set.labels);
  Standardisation result{std::vector<float>(inputs), std::vector<float>(inputs)};
  parallel_blocks(inputs, 1, [&](std::size_t u, std::size_t) {
    std::vector<Weighted> values;
    for (const std::vector<std::size_t>& samples : picked) {
      const double weight = 1.0 / static_cast<double>(samples.size());
      for (const std::size_t i : samples) {
        const float value = set.samples[i * inputs + u];
        if (std::isfinite(value)) values.push_back({value, weight});
      }
    }
    const bool is_odd = !odd.empty() && odd[u % static_cast<std::size_t>(features)] != 0;
    const Spread spread = limited_spread(values, is_odd);
    result.mean[u] = static_cast<float>(spread.mean);
    result.inverse_deviation[u] = static_cast<float>(1.0 / std::max(spread.deviation, 1e-6));
  });
  return result;
}

}  // namespace pcednet::nn
