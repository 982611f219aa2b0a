#include "pcednet/core/progress.h"

#include <algorithm>
#include <utility>

#include "pcednet/core/error.h"

namespace pcednet {

Stage::Stage(const Progress* progress, std::string name, std::size_t total)
    : progress_(progress), name_(std::move(name)), total_(std::max<std::size_t>(total, 1)) {
  if (progress_ && progress_->report) progress_->report(name_, 0.0);
}

void Stage::advance(std::size_t steps) {
  throw_if_cancelled(progress_);
  const std::size_t done = done_.fetch_add(steps) + steps;
  if (!progress_ || !progress_->report) return;
  const std::size_t permille = done * 1000 / total_;
  const std::lock_guard lock(mutex_);
  if (permille <= reported_permille_) return;
  reported_permille_ = permille;
  progress_->report(name_, static_cast<double>(done) / static_cast<double>(total_));
}

Progress without_report(const Progress* progress) {
  return {.report = {}, .cancelled = progress ? progress->cancelled : std::function<bool()>()};
}

void throw_if_cancelled(const Progress* progress) {
  if (progress && progress->cancelled && progress->cancelled()) {
    throw Error(ErrorKind::kCancelled, "stopped by the user");
  }
}

}  // namespace pcednet
