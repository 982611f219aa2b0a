#pragma once

#include <cstdint>

namespace pcednet::app {

/// Bytes of unused memory: of the machine, or of the control groups (of a container, a job) of this
/// process, whichever is less.
std::uint64_t free_memory();

}  // namespace pcednet::app
