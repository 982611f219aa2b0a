#include "pcednet/core/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/exists_already.h"

namespace pcednet {
namespace {

namespace fs = std::filesystem;

/// Renames unless `to` exists. On failure, errno has the reason.
bool rename_without_replacing(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  // Not every file system can (NFS cannot); a hard link never replaces either.
  if (errno != EINVAL && errno != ENOSYS) return false;
  if (link(from.c_str(), to.c_str()) != 0) return false;
  unlink(from.c_str());
  return true;
}

/// The temporary file for the bytes of `path`.
std::string part_name(const fs::path& path) {
  return fmt::format("{}.part-{}", path.string(), getpid());
}

/// Throws unless a file can be created beside `path`.
void check_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: cannot be written: {}", path.string(), why));
  };
  if (status.type() == fs::file_type::not_found) {
    refuse(fmt::format("there is no folder {}", folder.string()));
  }
  if (fs::exists(status) && !fs::is_directory(status)) {
    refuse(fmt::format("{} is not a folder", folder.string()));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(fmt::format("folder {}: {}", folder.string(), std::strerror(errno)));
  }
  static_cast<void>(fs::symlink_status(part_name(path), error));
  if (error == std::errc::filename_too_long) refuse(error.message());
}

}  // namespace

void check_writable(const fs::path& path, Overwrite overwrite) {
  if (path.empty()) return;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: is a folder", path.string()));
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: is a device, a pipe or a socket, not a file", path.string()));
  }
  if (overwrite == Overwrite::kNo && fs::exists(fs::symlink_status(path, ignored))) {
    throw ExistsAlready(path);
  }
  check_folder_of(path);
}

void check_not_input(const fs::path& output, const fs::path& input) {
  std::error_code error;
  if (!fs::equivalent(output, input, error)) return;
  throw Error(ErrorKind::kUsage, fmt::format("{}: is the input", output.string()));
}

void make_folder(const fs::path& folder) {
  std::error_code error, ignored;
  if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored)) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: is a file, not a folder", folder.string()));
  }
  fs::create_directories(folder, error);
  if (!error) return;
  throw Error(ErrorKind::kFailure,
              fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
}

OutputFile::OutputFile(fs::path path, Overwrite overwrite)
    : path_(std::move(path)), overwrite_(overwrite) {
  if (path_.empty()) throw Error(ErrorKind::kUsage, "the name of a file to write is empty");
  check_writable(path_, overwrite);
  const std::string name = part_name(path_);
  temporary_ = name;
  // Another machine may share the folder, and another thread the process.
  for (int i = 1; !(file_ = std::fopen(temporary_.c_str(), "wbxe")) && errno == EEXIST; ++i) {
    temporary_ = fmt::format("{}-{}", name, i);
  }
  if (!file_) fail("cannot create");
}

OutputFile::~OutputFile() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::fail(const std::string& action) const {
  throw Error(ErrorKind::kFailure,
              fmt::format("{}: {} the file: {}", path_.string(), action, std::strerror(errno)));
}

void OutputFile::write(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot write");
}

void OutputFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text)));
}

void OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  // Bytes buffered by write() would overwrite these later.
  if (std::fflush(file_) != 0) fail("cannot write");
  while (!bytes.empty()) {
    const ssize_t written =
        pwrite(fileno(file_), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot write");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::commit() {
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail("cannot write");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot write");
  const bool renamed = overwrite_ == Overwrite::kYes
                           ? std::rename(temporary_.c_str(), path_.c_str()) == 0
                           : rename_without_replacing(temporary_, path_);
  if (!renamed && errno == EEXIST) throw ExistsAlready(path_);
  if (!renamed) fail("cannot rename into place");
  temporary_.clear();
}

void write_text_file(const std::filesystem::path& path, std::string_view text,
                     Overwrite overwrite) {
  OutputFile file(path, overwrite);
  file.write(text);
  file.commit();
}

}  // namespace pcednet
