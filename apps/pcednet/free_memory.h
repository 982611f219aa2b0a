#pragma once

#include <cstdint>

namespace pcednet::app {

/// Bytes of memory that nobody uses: of the machine, or of the control groups (of a container, a
/// job) that this process is in, whichever is less.
std::uint64_t free_memory();

}  // namespace pcednet::app
