#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "pcednet/core/error.h"

namespace pcednet::io {

/// An Error(kUnreadable) that names the file, and the line in it unless that is 0.
Error unreadable(const std::filesystem::path& path, const std::string& what, std::size_t line = 0);

/// A file opened for reading at any place, from any thread.
class InputFile {
 public:
  /// Throws Error(kUnreadable) unless `path` is a regular file that may be read.
  explicit InputFile(std::filesystem::path path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Fills `bytes` from `offset`. Throws Error(kUnreadable), naming the byte, if the file ends
  /// before.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

  /// The bytes from `offset` on, at most `count`.
  std::string text(std::uint64_t offset = 0, std::uint64_t count = UINT64_MAX) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace pcednet::io
