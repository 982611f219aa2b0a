#include "browser.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
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

}  // namespace pcednet::app
