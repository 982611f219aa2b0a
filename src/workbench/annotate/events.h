#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>

#include "workbench/annotate/messages.h"

namespace pcednet::annotate {

/// Events on their way from the session to any number of windows, in the form of server-sent
/// events. A window that reads too slowly loses the oldest. Every function may be called from any
/// thread.
class Events {
 public:
  void add(const Event& event);

  /// Calls `on_news` after every event from now on, from the thread that adds it; `on_news` must
  /// not wait, nor call this object. An empty one ends that: the former is not called any more.
  void notify(std::function<void()> on_news);

  /// The number of the event after the last.
  std::uint64_t end() const;

  /// The events from number `next` on, which is moved behind them; empty if there are none.
  std::string take(std::uint64_t& next) const;

 private:
  mutable std::mutex mutex_;
  std::function<void()> on_news_;
  std::deque<std::string> recent_;
  std::uint64_t end_ = 0;
};

}  // namespace pcednet::annotate
