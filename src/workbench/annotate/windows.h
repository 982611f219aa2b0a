#pragma once

#include <mutex>
#include <string>

namespace pcednet::annotate {

/// The windows of the page: at most one of them paints. Every function may be called from any
/// thread.
class Windows {
 public:
  struct Opened {
    std::string name = {};
    bool is_writer = false;
  };
  /// A new window; it paints if none does.
  Opened open();

  /// Makes `window` the one that paints. Throws NotFound if there is none of that name.
  void take_over(const std::string& window);

  bool is_writer(const std::string& window) const;
  bool is_any_open() const;

 private:
  mutable std::mutex mutex_;
  std::string writer_;
  int count_ = 0;
};

}  // namespace pcednet::annotate
