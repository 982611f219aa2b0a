#pragma once

#include <string>

#include "pcednet/core/error.h"

namespace pcednet::python {

/// The value of that name in a table of names and values. Throws Error(kUsage), with the names.
template <typename Table>
auto named(const Table& table, const std::string& what, const std::string& name) {
  std::string names;
  for (const auto& [known, value] : table) {
    if (known == name) return value;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw Error(ErrorKind::kUsage, what + " \"" + name + "\": there are " + names);
}

}  // namespace pcednet::python
