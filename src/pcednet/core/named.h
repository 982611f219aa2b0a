#pragma once

#include <string>
#include <string_view>

#include "pcednet/core/error.h"

namespace pcednet {

/// The value of that name in a table of names and values. Throws Error(kUsage), which says what is
/// named and lists the names.
template <typename Table>
auto named(const Table& table, const std::string& what, std::string_view name) {
  std::string names;
  for (const auto& [known, value] : table) {
    if (known == name) return value;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw Error(ErrorKind::kUsage, what + " \"" + std::string(name) + "\": there are " + names);
}

}  // namespace pcednet
