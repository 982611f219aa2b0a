#pragma once

#include <cstdint>
#include <string>

namespace pcednet::app {

/// Bytes of unused memory: of the machine, of the control groups (of a container, a job) of this
/// process, or of its address space (ulimit -v), whichever is least.
std::uint64_t free_memory();

/// Bytes as users write them: 2G, 500M, 4096. K, M and G are powers of 1024. Throws Error(kUsage),
/// naming `option`, for anything else.
std::uint64_t byte_size(const std::string& option, const std::string& text);

/// "1.5 GiB".
std::string size_text(std::uint64_t bytes);

}  // namespace pcednet::app
