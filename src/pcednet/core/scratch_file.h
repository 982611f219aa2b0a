#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace pcednet {

/// Bytes too many for memory, in an unnamed file that vanishes however the process ends.
class ScratchFile {
 public:
  /// Lies on the disk of `beside`, the output under construction, which errors name. Throws
  /// Error(kFailure) if no file can be created in that folder.
  explicit ScratchFile(std::filesystem::path beside);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::uint64_t size() const { return size_; }

  /// Appends. Throws Error(kFailure) when the disk is full.
  void write(std::string_view bytes);

  /// Writes at an offset, which may lie beyond the end: the gap reads as zeros. From one thread at
  /// a time. Throws as write() does.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Fills `bytes` from `offset`, from any thread. Throws Error(kFailure) if the file ends before.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path beside_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace pcednet
