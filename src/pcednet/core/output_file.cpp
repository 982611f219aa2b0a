#include "pcednet/core/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "pcednet/core/error.h"

namespace pcednet {

void check_writable(const std::filesystem::path& path, Overwrite overwrite) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: is a folder", path.string()));
  }
  if (overwrite == Overwrite::kNo && std::filesystem::exists(path, ignored)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: exists already; give --overwrite to replace it", path.string()));
  }
}

OutputFile::OutputFile(std::filesystem::path path, Overwrite overwrite) : path_(std::move(path)) {
  check_writable(path_, overwrite);
  temporary_ = path_;
  temporary_ += fmt::format(".part-{}", getpid());
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (!file_) fail("cannot create");
}

OutputFile::~OutputFile() {
  if (!file_) return;
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
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
  // What write() still holds would replace these bytes later.
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
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    throw Error(ErrorKind::kFailure,
                fmt::format("{}: cannot rename into place: {}", path_.string(), error.message()));
  }
}

void write_text_file(const std::filesystem::path& path, std::string_view text,
                     Overwrite overwrite) {
  OutputFile file(path, overwrite);
  file.write(text);
  file.commit();
}

}  // namespace pcednet
