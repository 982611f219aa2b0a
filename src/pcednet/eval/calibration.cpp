#include "pcednet/eval/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"

namespace pcednet::eval {

void add_calibration(std::span<const std::uint8_t> truth, std::span<const float> probabilities,
                     Positive positive, Calibration& calibration) {
  if (truth.size() != probabilities.size()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{} probabilities for {} labelled points",
                                                      probabilities.size(), truth.size()));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == kUnlabelled) continue;
    const double p = std::clamp(static_cast<double>(probabilities[i]), 0.0, 1.0);
    const auto bins = static_cast<double>(calibration.size());
    CalibrationBin& bin =
        calibration[std::min(calibration.size() - 1, static_cast<std::size_t>(p * bins))];
    ++bin.points;
    bin.sum_probability += p;
    bin.positive += is_positive(truth[i], positive);
  }
}

double calibration_error(const Calibration& calibration) {
  double difference = 0.0;
  std::size_t points = 0;
  for (const CalibrationBin& bin : calibration) {
    difference += std::abs(bin.sum_probability - static_cast<double>(bin.positive));
    points += bin.points;
  }
  return points == 0 ? 0.0 : difference / static_cast<double>(points);
}

}  // namespace pcednet::eval
