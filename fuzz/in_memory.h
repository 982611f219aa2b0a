#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>

#include "pcednet/core/error.h"

namespace pcednet::fuzz {

/// A file without a disk under it.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes)
      : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
    if (descriptor_ < 0) std::abort();
    while (!bytes.empty()) {
      const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
      if (put <= 0) std::abort();
      bytes = bytes.subspan(static_cast<std::size_t>(put));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Reads the bytes as a file: an Error is a valid outcome, any other exception is not.
template <typename Read>
int read_or_refuse(std::span<const std::uint8_t> bytes, Read&& read) {
  const MemoryFile file(bytes);
  try {
    read(file.path());
  } catch (const Error&) {
  }
  return 0;
}

}  // namespace pcednet::fuzz
