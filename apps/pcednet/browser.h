#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pcednet::app {

/// Opens a page with a secret address in the user's browser. All users of the machine can read a
/// program's command line, so it holds the name of a file, readable only by this user, that
/// redirects to the page.
class BrowserTab {
 public:
  /// Calls the desktop's `xdg-open`; does nothing if there is none. Throws Error(kFailure) if the
  /// file cannot be written. `url` must not need escapes in HTML.
  explicit BrowserTab(const std::string& url);

  /// Removes the file.
  ~BrowserTab();
  BrowserTab(const BrowserTab&) = delete;
  BrowserTab& operator=(const BrowserTab&) = delete;

 private:
  std::filesystem::path folder_;
};

/// A port of 127.0.0.1 and its token.
struct Address {
  int port = 0;
  std::string token = {};
};

/// The last address of a project, in a file beside it that only this user can read: a page that is
/// still open can then reconnect to a new start of the program. Where no such file can be made,
/// nothing is kept, and a new start has another address.
class KeptAddress {
 public:
  explicit KeptAddress(const std::filesystem::path& project);

  /// The address, if the program was running in the last twelve hours.
  std::optional<Address> read() const;

  void write(const Address& address) const;

  /// Notes that the program is still running.
  void touch() const;

 private:
  std::filesystem::path path_;
};

}  // namespace pcednet::app
