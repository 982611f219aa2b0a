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
  /// A new window; it paints if none does.
  Opened open();

  /// Makes `window` the one that paints. Throws NotFound if there is none of that name.
  void take_over(const std::string& window);

  /// The window is closed. If it painted, the one that was opened last does from now on: returns
  /// its name, which is empty if there is none. Throws NotFound like take_over().
  std::optional<std::string> leave(const std::string& window);

  bool is_writer(const std::string& window) const;

  /// Whether it was opened here: a window of an earlier start of the program has another name.
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
