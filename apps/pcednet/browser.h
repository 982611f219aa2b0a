#pragma once

#include <filesystem>
#include <string>

namespace pcednet::app {

/// Shows a page in the user's browser whose address nobody else may know. The command line of a
/// program can be read by every user of the machine: on it goes the name of a file that only this
/// user can read, which leads to the page.
class BrowserTab {
 public:
  /// Leaves the rest to the desktop's `xdg-open`; nothing happens where there is none. Throws
  /// Error(kFailure) if the file cannot be written. `url` must not need escapes in HTML.
  explicit BrowserTab(const std::string& url);

  /// Removes the file.
  ~BrowserTab();
  BrowserTab(const BrowserTab&) = delete;
  BrowserTab& operator=(const BrowserTab&) = delete;

 private:
  std::filesystem::path folder_;
};

}  // namespace pcednet::app
