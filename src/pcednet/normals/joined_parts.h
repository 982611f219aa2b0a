#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcednet::normals {

/// The row that a row joins (itself if none), and the relative sign of the two: 1 or -1.
struct Join {
  std::uint32_t to;
  std::int8_t sign;
};

/// The parts that rows (points, or the parts of the previous round) belong to, and their signs.
struct Signs {
  std::vector<std::int8_t> sign;    ///< per row, 1 or -1: that of the part's first row is 1
  std::vector<std::uint32_t> part;  ///< per row, in the order of the parts' first rows
  std::size_t parts = 0;
};

/// The parts that the joins connect. Each path along them must end in a row that joins itself, or
/// in two rows that join each other with the same sign.
Signs follow_joins(std::vector<Join> joins);

/// The signs and parts of the rows of `finer`, whose parts are the rows of `coarser`.
void join_again(Signs& finer, const Signs& coarser);

}  // namespace pcednet::normals
