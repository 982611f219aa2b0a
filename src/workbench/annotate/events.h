#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>

#include "workbench/annotate/messages.h"

namespace pcednet::annotate {

/// Queues events from the session for any number of windows, in the form of server-sent events. A
/// window that reads too slowly loses the oldest. Every function may be called from any thread.
class Events {
 public:
  void add(const Event& event);

  /// Calls `on_news` after every event from now on, from the thread that adds it; `on_news` must
  /// not wait, nor call this object. An empty one removes the callback.
  void notify(std::function<void()> on_news);

  /// The number of the event after the last.
  std::uint64_t end() const;

  /// The events from number `next` on; moves `next` behind them. Empty if there are none.
  std::string take(std::uint64_t& next) const;

 private:
  mutable std::mutex mutex_;
  std::function<void()> on_news_;
  std::deque<std::string> recent_;
  std::uint64_t end_ = 0;
};

}  // namespace pcednet::annotate
