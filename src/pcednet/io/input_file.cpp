#include "pcednet/io/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace pcednet::io {
namespace {

/// The reason not to read a file of that mode, which is not a regular one.
const char* why_unreadable(mode_t mode) {
  if (S_ISDIR(mode)) return "is a folder";
  if (S_ISFIFO(mode)) return "is a pipe, and is read at several places: save it as a file";
  return "is not a regular file";
}

}  // namespace

Error unreadable(const std::filesystem::path& path, const std::string& what, std::size_t line) {
  const std::string place = line == 0 ? "" : fmt::format(":{}", line);
  return {ErrorKind::kUnreadable, fmt::format("{}{}: {}", path.string(), place, what)};
}

InputFile::InputFile(std::filesystem::path path) : path_(std::move(path)) {
  // A FIFO without a writer would block here otherwise.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throw unreadable(path_, std::strerror(errno));
  struct stat status = {};
  const bool regular = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (!regular) {
    ::close(descriptor_);
    throw unreadable(path_, why_unreadable(status.st_mode));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  ::close(descriptor_);
}

void InputFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw unreadable(path_, fmt::format("byte {}: {}", offset, std::strerror(errno)));
    if (got == 0) {
      throw unreadable(path_,
                       fmt::format("ends at byte {}, {} bytes too early", offset, bytes.size()));
    }
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

std::string InputFile::text(std::uint64_t offset, std::uint64_t count) const {
  std::string text(std::min(count, size_ - std::min(offset, size_)), '\0');
  read(offset, std::as_writable_bytes(std::span(text)));
  return text;
}

}  // namespace pcednet::io
