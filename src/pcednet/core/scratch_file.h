#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace pcednet {

/// Bytes that memory should not hold, in a file without a name: nothing of it stays behind,
/// whichever way the process ends.
class ScratchFile {
 public:
  /// On the disk of `beside`, the file that is being made of it, which errors name. Throws
  /// Error(kFailure) if its folder takes no file.
  explicit ScratchFile(std::filesystem::path beside);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::uint64_t size() const { return size_; }

  /// Appends. Throws Error(kFailure) when the disk is full.
  void write(std::string_view bytes);

  /// Writes at an offset, which may lie beyond the end: what is between reads as zeros. From one
  /// thread at a time. Throws as write() does.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Fills `bytes` with what stands at `offset`, from any thread. Throws Error(kFailure) if that is
  /// not there.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path beside_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace pcednet
