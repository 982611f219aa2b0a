#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace pcednet {

enum class Overwrite { kNo, kYes };

/// A file that appears under its name only when it is complete.
///
/// Bytes go to a file beside the target; commit() renames it. Without commit (an exception, a
/// cancel) nothing stays behind and an existing target is untouched.
class OutputFile {
 public:
  /// Throws Error(kUsage) if `path` exists and `overwrite` is kNo, Error(kFailure) if nothing can
  /// be written there.
  explicit OutputFile(std::filesystem::path path, Overwrite overwrite = Overwrite::kNo);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Throws Error(kFailure), naming the file, when the disk takes no more.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Writes at a place of the file, which may lie beyond what is written so far; does not move
  /// where write() goes on. Throws as write() does.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Flushes to the disk and renames. Must be called once, last.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& action) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
};

/// Throws what OutputFile would throw because `path` is a folder or exists; for refusing before
/// long work. An empty path is fine.
void check_writable(const std::filesystem::path& path, Overwrite overwrite);

/// Writes `text` to `path` as a whole.
void write_text_file(const std::filesystem::path& path, std::string_view text,
                     Overwrite overwrite = Overwrite::kNo);

}  // namespace pcednet
