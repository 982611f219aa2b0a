#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pcednet {

/// "1 tile", "3 tiles": a number of what is named in the singular, with an s for its plural.
inline std::string counted(std::uint64_t count, std::string_view thing) {
  return std::to_string(count).append(" ").append(thing).append(count == 1 ? "" : "s");
}

}  // namespace pcednet
