#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/eval/scores.h"

namespace pcednet::eval {

/// The points whose probability of the positive classes lies in one tenth of [0, 1].
struct CalibrationBin {
  std::size_t points = 0;
  double sum_probability = 0.0;
  std::size_t positive = 0;  ///< with a positive true class
};

/// A reliability diagram: eight in ten points with probability 0.8 should be edges.
using Calibration = std::array<CalibrationBin, 10>;

/// Adds the points of a cloud. `probabilities` are those of the positive classes; a point
/// whose truth is kUnlabelled is left out. Throws Error(kInsufficient) if the sizes differ.
void add_calibration(std::span<const std::uint8_t> truth, std::span<const float> probabilities,
                     Positive positive, Calibration& calibration);

/// The expected calibration error: the mean over the points of the difference, in their bin,
/// between the mean probability and the share that is positive. 0 without points.
double calibration_error(const Calibration& calibration);

}  // namespace pcednet::eval
