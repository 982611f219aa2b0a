#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace pcednet::spatial {

/// Sorts the spacings and returns the middle half: a few outlying points change neither its mean
/// nor its ends.
inline std::span<const double> middle_half(std::vector<double>& spacings) {
  std::sort(spacings.begin(), spacings.end());
  const std::size_t quarter = spacings.size() / 4;
  return std::span(spacings).subspan(quarter, spacings.size() - 2 * quarter);
}

/// Whether the third quartile of the spacings is more than 1.6 times the first, as in scans from
/// one place.
inline bool is_uneven(std::span<const double> half) {
  constexpr double kEvenQuartiles = 1.6;
  return !half.empty() && half.back() > kEvenQuartiles * half.front();
}

}  // namespace pcednet::spatial
