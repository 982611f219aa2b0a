#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcednet {

/// The middle value, or the mean of the middle two; 0 if there are none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// The value at `rank`, from 0, in sorted order; reorders the values.
template <typename T>
T value_at_rank(std::vector<T>& values, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The middle value, or the upper of the middle two: always one of `values`, which must not be
/// empty.
template <typename T>
T upper_median(std::vector<T> values) {
  return value_at_rank(values, values.size() / 2);
}

}  // namespace pcednet
