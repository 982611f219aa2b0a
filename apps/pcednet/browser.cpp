#include "browser.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>

#include "pcednet/core/error.h"

extern char** environ;

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

/// A new folder that only this user can enter.
fs::path private_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::error_code error;
  const bool is_there = runtime && fs::is_directory(runtime, error);
  std::string folder =
      ((is_there ? fs::path(runtime) : fs::temp_directory_path()) / "pcednet-XXXXXX").string();
  if (!::mkdtemp(folder.data())) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: {}", folder, std::strerror(errno)));
  }
  return folder;
}

void write_private(const fs::path& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const bool is_written =
      file >= 0 && ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int why = errno;
  if (file >= 0) ::close(file);
  if (!is_written) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: {}", path.string(), std::strerror(why)));
  }
}

void open_on_desktop(const fs::path& file) {
  std::string program = "xdg-open", argument = file.string();
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "xdg-open", nullptr, nullptr, arguments, environ) != 0) return;
  std::thread([child] { waitpid(child, nullptr, 0); }).detach();
}

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

BrowserTab::BrowserTab(const std::string& url) : folder_(private_folder()) {
  const fs::path file = folder_ / "annotate.html";
  try {
    write_private(file, fmt::format("<!doctype html>\n<meta charset=\"utf-8\">\n"
                                    "<meta http-equiv=\"refresh\" content=\"0;url={0}\">\n"
                                    "<a href=\"{0}\">pcednet annotate</a>\n",
                                    url));
    open_on_desktop(file);
  } catch (...) {
    std::error_code error;
    fs::remove_all(folder_, error);
    throw;
  }
}

BrowserTab::~BrowserTab() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

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
