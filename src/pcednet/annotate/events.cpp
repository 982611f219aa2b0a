#include "pcednet/annotate/events.h"

#include <algorithm>

namespace pcednet::annotate {
namespace {

constexpr std::size_t kMostKept = 1000;

}  // namespace

void Events::add(const std::string& name, const std::string& json) {
  {
    const std::lock_guard lock(mutex_);
    recent_.push_back("event: " + name + "\ndata: " + json + "\n\n");
    ++end_;
    if (recent_.size() > kMostKept) recent_.pop_front();
  }
  changed_.notify_all();
}

void Events::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

std::uint64_t Events::end() const {
  const std::lock_guard lock(mutex_);
  return end_;
}

bool Events::take(std::uint64_t& next, std::chrono::milliseconds patience, std::string& text) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return closed_ || next < end_; });
  text.clear();
  next = std::max(next, end_ - recent_.size());
  for (; next < end_; ++next) text += recent_[recent_.size() - (end_ - next)];
  return !closed_;
}

}  // namespace pcednet::annotate
