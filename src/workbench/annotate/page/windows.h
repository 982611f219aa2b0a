#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
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

  /// Closes the window. If it could paint, the one opened last of those that listen, or else of
  /// all, can from now on: returns its name, empty if there is none. Throws NotFound like
  /// take_over().
  std::optional<std::string> leave(const std::string& window);

  /// The window receives events from now on. One that was closed for its silence is open again.
  /// Nothing happens, here and in the next two, if it is not of this run.
  void begin_listening(const std::string& window);
  void end_listening(const std::string& window);

  /// Closes the window like leave(), if it listens no longer: browsers end without a word, too.
  std::optional<std::string> close_silent(const std::string& window);

  bool is_writer(const std::string& window) const;

  /// Whether it was opened in this run: windows of an earlier run have other names.
  bool is_open(const std::string& window) const;
  bool was_any_opened() const;

 private:
  std::string name_of(int number) const;
  int number_of(const std::string& window) const;
  int number_in_run(const std::string& window) const;  ///< 0 if there was none
  std::optional<std::string> close(int number);

  const std::string start_;
  mutable std::mutex mutex_;
  std::set<int> open_;
  std::map<int, int> streams_;  ///< of events, to each window
  int writer_ = 0;              ///< 0: none
  int count_ = 0;
};

}  // namespace pcednet::annotate
