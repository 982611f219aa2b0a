#pragma once

#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace pcednet::annotate {

/// The windows of the page: at most one of them paints. Every function may be called from any
/// thread.
class Windows {
 public:
  Windows();

  struct Opened {
    std::string name = {};
    bool is_writer = false;
  };
  /// Opens a window; it may paint if no other does.
  Opened open();

  /// Makes `window` the one that paints. Throws NotFound if there is none of that name.
  void take_over(const std::string& window);

  /// Closes the window. If it could paint, the one opened last can from now on: returns its name,
  /// empty if there is none. Throws NotFound like take_over().
  std::optional<std::string> leave(const std::string& window);

  bool is_writer(const std::string& window) const;

  /// Whether it was opened in this run: windows of an earlier run have other names.
  bool is_open(const std::string& window) const;
  bool was_any_opened() const;

 private:
  std::string name_of(int number) const;
  int number_of(const std::string& window) const;

  const std::string start_;
  mutable std::mutex mutex_;
  std::set<int> open_;
  int writer_ = 0;  ///< 0: none
  int count_ = 0;
};

}  // namespace pcednet::annotate
