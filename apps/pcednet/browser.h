#pragma once

#include <filesystem>
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

}  // namespace pcednet::app
