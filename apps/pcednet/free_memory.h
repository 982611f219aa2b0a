#pragma once

#include <cstdint>

namespace pcednet::app {

/// Bytes of unused memory: of the machine, of the control groups (of a container, a job) of this
/// process, or of its address space (ulimit -v), whichever is least.
std::uint64_t free_memory();

}  // namespace pcednet::app
