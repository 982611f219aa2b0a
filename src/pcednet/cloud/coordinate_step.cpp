#include "pcednet/cloud/coordinate_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcednet {
namespace {

constexpr double kLeastExtent = 1e-8;  ///< a step is at least this part of the extent
constexpr double kOff = 0.1;           ///< of a step: what a coordinate may be off its multiple

/// The largest number of which all of these, sorted and beginning with 0, are multiples; infinite
/// if all are 0, and 0 if it would be below `least`. Later numbers make it more precise.
double common_step(std::span<const double> offsets, double least) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    const double gap = offsets[i] - offsets[i - 1];
    if (gap >= least) step = std::min(step, gap);
  }
  if (std::isinf(step)) return step;
  for (std::size_t i = 0; i < offsets.size();) {
    const double multiple = std::round(offsets[i] / step);
    const double off = std::abs(offsets[i] - multiple * step);
    if (off > kOff * step) {  // as in Euclid's algorithm
      if (off < least) return 0.0;
      step = off, i = 0;
      continue;
    }
    if (multiple > 0.0) step = offsets[i] / multiple;
    ++i;
  }
  return step;
}

}  // namespace

double coordinate_step(std::span<const Vec3> positions, std::span<const std::uint32_t> points) {
  if (points.empty()) return 0.0;
  double step = std::numeric_limits<double>::infinity();
  std::vector<double> offsets(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), offsets.begin(),
                   [&](std::uint32_t i) { return positions[i][axis]; });
    std::sort(offsets.begin(), offsets.end());
    const double first = offsets.front();
    for (double& offset : offsets) offset -= first;
    step = std::min(step, common_step(offsets, kLeastExtent * offsets.back()));
  }
  return std::isinf(step) ? 0.0 : step;
}

}  // namespace pcednet
