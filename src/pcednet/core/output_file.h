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
/// Bytes go to `<name>.part-<process>` in the folder of the target; commit() renames it. Without
/// commit (an exception, a cancel) nothing stays behind and an existing target is untouched. With
/// kNo the rename itself refuses a target that has appeared since: exactly one of several writers
/// succeeds, in any process. With kYes a symbolic link is replaced, not the file it points to.
class OutputFile {
 public:
  /// Throws what check_writable() throws, Error(kUsage) for an empty path, and Error(kFailure) if
  /// the file cannot be created.
  explicit OutputFile(std::filesystem::path path, Overwrite overwrite = Overwrite::kNo);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Throws Error(kFailure), naming the file, when the disk is full.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Writes at an offset, which may lie beyond the end of the file; does not move the position of
  /// write(). Throws as write() does.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Flushes to the disk and renames. Must be called once, last. Throws Error(kUsage) if the target
  /// exists by now and must not be replaced, Error(kFailure) when the disk is full.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& action) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< empty once the file has its name
  Overwrite overwrite_;
  std::FILE* file_ = nullptr;
};

/// Rejects, before long work, the targets that OutputFile would reject after it. Throws
/// Error(kUsage) if `path` is a folder or a device, or exists (even as a dangling link) and
/// `overwrite` is kNo; Error(kFailure) if its folder is missing, not a folder, or not writable. An
/// empty path is valid.
void check_writable(const std::filesystem::path& path, Overwrite overwrite);

/// Throws Error(kUsage) if `output` is the file `input`, also by a link, which it would replace by
/// something else.
void check_not_input(const std::filesystem::path& output, const std::filesystem::path& input);

/// Creates the folder and its missing parents. Throws Error(kUsage) if it is a file,
/// Error(kFailure) if it cannot be created.
void make_folder(const std::filesystem::path& folder);

/// Writes `text` to `path` as a whole.
void write_text_file(const std::filesystem::path& path, std::string_view text,
                     Overwrite overwrite = Overwrite::kNo);

}  // namespace pcednet
