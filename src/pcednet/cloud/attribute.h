#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace pcednet {

/// The number types that point files hold.
enum class ScalarType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
};

/// Bytes of one number.
constexpr std::size_t size_of(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
    case ScalarType::kUint8:
      return 1;
    case ScalarType::kInt16:
    case ScalarType::kUint16:
      return 2;
    case ScalarType::kInt32:
    case ScalarType::kUint32:
    case ScalarType::kFloat32:
      return 4;
    case ScalarType::kInt64:
    case ScalarType::kUint64:
    case ScalarType::kFloat64:
      return 8;
  }
  return 0;
}

constexpr bool is_floating(ScalarType type) {
  return type == ScalarType::kFloat32 || type == ScalarType::kFloat64;
}

template <typename T>
constexpr ScalarType scalar_type_of() {
  if constexpr (std::is_same_v<T, std::int8_t>)
    return ScalarType::kInt8;
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return ScalarType::kUint8;
  else if constexpr (std::is_same_v<T, std::int16_t>)
    return ScalarType::kInt16;
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return ScalarType::kUint16;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return ScalarType::kInt32;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return ScalarType::kUint32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return ScalarType::kInt64;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return ScalarType::kUint64;
  else if constexpr (std::is_same_v<T, float>)
    return ScalarType::kFloat32;
  else
    return ScalarType::kFloat64;
}

/// Calls `action(T{})` with a zero of the C++ type behind `type`.
template <typename Action>
decltype(auto) visit_scalar(ScalarType type, Action&& action) {
  switch (type) {
    case ScalarType::kInt8:
      return action(std::int8_t{});
    case ScalarType::kUint8:
      return action(std::uint8_t{});
    case ScalarType::kInt16:
      return action(std::int16_t{});
    case ScalarType::kUint16:
      return action(std::uint16_t{});
    case ScalarType::kInt32:
      return action(std::int32_t{});
    case ScalarType::kUint32:
      return action(std::uint32_t{});
    case ScalarType::kInt64:
      return action(std::int64_t{});
    case ScalarType::kUint64:
      return action(std::uint64_t{});
    case ScalarType::kFloat32:
      return action(float{});
    case ScalarType::kFloat64:
      break;
  }
  return action(double{});
}

/// The number of that type at `bytes`, which need not be aligned, as a double.
inline double to_double(ScalarType type, const std::byte* bytes) {
  return visit_scalar(type, [&](auto number) {
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<double>(number);
  });
}

/// Whether a number, its fraction aside, lies in the range of an integer type.
template <typename Integer>
bool is_in_range(double value) {
  // 2^bits is a double, the largest value of a 64-bit type is not.
  constexpr Integer kHalf = std::numeric_limits<Integer>::max() / 2;
  constexpr double kEnd = 2.0 * (static_cast<double>(kHalf) + 1.0);
  return value >= static_cast<double>(std::numeric_limits<Integer>::min()) && value < kEnd;
}

/// One named number (or a few, see `components`) per point, kept in the type it was read in.
struct Attribute {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::size_t components = 1;    ///< numbers per point
  std::vector<std::byte> bytes;  ///< points x components numbers, native byte order

  std::size_t stride() const { return components * size_of(type); }

  /// Number `component` of `point`, as a double.
  double value(std::size_t point, std::size_t component = 0) const {
    return to_double(type, bytes.data() + point * stride() + component * size_of(type));
  }
};

/// An attribute from a vector of numbers, one per point.
template <typename T>
Attribute make_attribute(std::string name, const std::vector<T>& values) {
  Attribute attribute{std::move(name), scalar_type_of<T>(), 1, {}};
  attribute.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(attribute.bytes.data(), values.data(), attribute.bytes.size());
  return attribute;
}

}  // namespace pcednet
