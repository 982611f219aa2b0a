#pragma once

#include <filesystem>
#include <vector>

namespace pcednet::app {

/// A folder for results, with its missing parents. Unless keep() is called, those that it made and
/// that are still empty go with it: a command that is refused leaves none behind.
class MadeFolder {
 public:
  /// Throws as make_folder() does. An empty path makes nothing.
  explicit MadeFolder(const std::filesystem::path& folder);
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;
  ~MadeFolder();

  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;  ///< the deepest first
};

}  // namespace pcednet::app
