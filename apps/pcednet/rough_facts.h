#pragma once

#include <cstdint>

#include "pcednet/io/input_file.h"

namespace pcednet::app {

/// What the beginning of a point file tells.
struct RoughFacts {
  std::uint64_t points = 0;  ///< by the header, otherwise by the length of the first lines
  bool has_normals = false;  ///< the header, or a heading, names some
};

/// Throws Error(kUnreadable) for a header that cannot be read.
RoughFacts rough_facts(const io::InputFile& file);

}  // namespace pcednet::app
