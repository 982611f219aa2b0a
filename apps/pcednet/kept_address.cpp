#include "kept_address.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>

namespace pcednet::app {
namespace {

constexpr std::time_t kSeconds = 12 * 3600;

/// An open file, closed on destruction.
struct Opened {
  int file = -1;
  ~Opened() {
    if (file >= 0) ::close(file);
  }
};

/// Whether no other user can read it; some file systems have no modes.
bool is_private(int file, struct stat& facts) {
  return ::fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_uid == ::geteuid() &&
         (facts.st_mode & 077) == 0;
}

}  // namespace

KeptAddress::KeptAddress(const std::filesystem::path& project) : path_(project) {
  path_ += ".address";
}

std::optional<Address> KeptAddress::read() const {
  const Opened opened{::open(path_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC)};
  struct stat facts = {};
  if (opened.file < 0 || !is_private(opened.file, facts)) return {};
  if (std::time(nullptr) - facts.st_mtime > kSeconds) return {};
  char text[64] = {}, token[33] = {};
  Address address;
  if (::read(opened.file, text, sizeof text - 1) <= 0) return {};
  if (std::sscanf(text, "%5d %32[0-9a-f]", &address.port, token) != 2) return {};
  address.token = token;
  if (address.port < 1 || address.port > 65535 || address.token.size() != 32) return {};
  return address;
}

void KeptAddress::write(const Address& address) const {
  ::unlink(path_.c_str());
  const Opened opened{
      ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600)};
  if (opened.file < 0) return;
  const std::string text = fmt::format("{} {}\n", address.port, address.token);
  struct stat facts = {};
  const bool is_kept =
      is_private(opened.file, facts) &&
      ::write(opened.file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (!is_kept) ::unlink(path_.c_str());
}

void KeptAddress::touch() const {
  ::utimensat(AT_FDCWD, path_.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
}

}  // namespace pcednet::app
