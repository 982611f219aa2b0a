#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "pcednet/io/ply/header.h"

namespace pcednet::io {

inline void reverse_bytes(std::byte* number, std::size_t size) {
  std::reverse(number, number + size);
}

/// Walks one row of `element`, lists and all, from `row` on: calls
/// `visit(property, number, type, is_length)` for each number in it, lengths of lists included.
/// With `swap` the bytes of each number are reversed in place first. Returns the row's end, or
/// null if it would lie beyond `end` or a list has a negative length.
template <typename Visit>
std::byte* walk_ply_row(const PlyElement& element, std::byte* row, const std::byte* end, bool swap,
                        Visit&& visit) {
  const auto take = [&](std::size_t property, ScalarType type, bool is_length) {
    std::byte* number = row;
    row += size_of(type);
    if (swap) reverse_bytes(number, size_of(type));
    visit(property, number, type, is_length);
    return number;
  };
  const auto left = [&] { return static_cast<std::uint64_t>(end - row); };
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    std::uint64_t numbers = 1;
    if (property.length_type) {
      if (left() < size_of(*property.length_type)) return nullptr;
      const std::byte* length = take(p, *property.length_type, true);
      const bool negative = visit_scalar(*property.length_type, [&](auto value) {
        std::memcpy(&value, length, sizeof value);
        numbers = static_cast<std::uint64_t>(value);
        return value < decltype(value){0};
      });
      if (negative) return nullptr;
    }
    if (numbers > left() / size_of(property.type)) return nullptr;
    for (std::uint64_t i = 0; i < numbers; ++i) take(p, property.type, false);
  }
  return row;
}

}  // namespace pcednet::io
