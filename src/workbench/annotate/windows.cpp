#include "workbench/annotate/windows.h"

#include <fmt/format.h>

#include <charconv>

#include "workbench/annotate/not_found.h"

namespace pcednet::annotate {
namespace {

std::string name_of(int number) {
  return fmt::format("w{}", number);
}

}  // namespace

Windows::Opened Windows::open() {
  const std::lock_guard lock(mutex_);
  const std::string window = name_of(++count_);
  if (writer_.empty()) writer_ = window;
  return {window, writer_ == window};
}

void Windows::take_over(const std::string& window) {
  const std::lock_guard lock(mutex_);
  int number = 0;
  if (!window.empty()) std::from_chars(window.data() + 1, window.data() + window.size(), number);
  if (number < 1 || number > count_ || name_of(number) != window) {
    throw NotFound("there is no such window");
  }
  writer_ = window;
}

bool Windows::is_writer(const std::string& window) const {
  const std::lock_guard lock(mutex_);
  return !writer_.empty() && window == writer_;
}

bool Windows::is_any_open() const {
  const std::lock_guard lock(mutex_);
  return count_ > 0;
}

}  // namespace pcednet::annotate
