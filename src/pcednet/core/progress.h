#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace pcednet {

/// The caller's callbacks for progress and cancellation of long work.
/// Both functions may be empty. One thread at a time calls `report`, several may call `cancelled`.
struct Progress {
  std::function<void(const std::string& stage, double fraction)> report;
  std::function<bool()> cancelled;
};

/// One stage of long work. Any thread may advance it.
class Stage {
 public:
  /// `progress` may be null; otherwise it must outlive the stage.
  Stage(const Progress* progress, std::string name, std::size_t total);

  /// Adds `steps` to the steps done. Throws Error(kCancelled) once the caller cancels.
  void advance(std::size_t steps = 1);

 private:
  const Progress* progress_;
  std::string name_;
  std::size_t total_;
  std::atomic<std::size_t> done_ = 0;
  std::size_t reported_permille_ = 0;
  std::mutex mutex_;
};

/// `progress` (which may be null) without its report, for work within a stage.
Progress without_report(const Progress* progress);

/// Throws Error(kCancelled) if `progress` (which may be null) asks to cancel.
void throw_if_cancelled(const Progress* progress);

}  // namespace pcednet
