#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::python {

namespace py = pybind11;

/// Arrays from the Python package: of this type, C-contiguous, aligned. Anything else is an error
/// of the package and is not converted here.
template <typename T>
using Array = py::array_t<T, py::array::c_style>;
template <typename T>
using OptionalArray = std::optional<Array<T>>;

/// The numbers of an array, which must outlive the span.
template <typename T>
std::span<const T> numbers(const Array<T>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

template <typename T>
std::span<const T> numbers(const OptionalArray<T>& array) {
  return array ? numbers(*array) : std::span<const T>();
}

/// An array of n x 3 as n vectors, in place.
inline std::span<const Vec3> vectors(const Array<double>& array) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return {reinterpret_cast<const Vec3*>(array.data()), static_cast<std::size_t>(array.size()) / 3};
}

inline std::span<const Vec3> vectors(const OptionalArray<double>& array) {
  return array ? vectors(*array) : std::span<const Vec3>();
}

/// An array of `shape` that owns `values`, which are not copied; `Number` is their number type.
template <typename Number, typename T>
py::array_t<Number> give(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  if (values.empty()) return py::array_t<Number>(shape);
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* held) { delete static_cast<std::vector<T>*>(held); });
  return py::array_t<Number>(shape, reinterpret_cast<const Number*>(kept->data()), owner);
}

/// One number per point.
template <typename T>
py::array_t<T> give(std::vector<T>&& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return give<T>(std::move(values), {count});
}

/// Vectors as n x 3.
inline py::array_t<double> give(std::vector<Vec3>&& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return give<double>(std::move(values), {count, 3});
}

}  // namespace pcednet::python
