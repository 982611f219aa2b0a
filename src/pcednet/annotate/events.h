#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

namespace pcednet::annotate {

/// Events on their way from the session to any number of windows. A window that reads too slowly
/// loses the oldest; it asks for the session anew when it connects again.
class Events {
 public:
  /// May be called from any thread.
  void add(const std::string& name, const std::string& json);

  /// Lets every reader return.
  void close();

  /// The number of the event after the last.
  std::uint64_t end() const;

  /// The events from number `next` on, which is moved behind them, in the form of server-sent
  /// events; empty if there is none within `patience`. False once closed.
  bool take(std::uint64_t& next, std::chrono::milliseconds patience, std::string& text);

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> recent_;
  std::uint64_t end_ = 0;
  bool closed_ = false;
};

}  // namespace pcednet::annotate
