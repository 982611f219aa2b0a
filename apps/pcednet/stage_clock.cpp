#include "stage_clock.h"

#include <fmt/format.h>

#include <algorithm>

namespace pcednet::app {

StageClock::StageClock(Progress progress) : progress_(std::move(progress)) {
  timed_.cancelled = progress_.cancelled;
  timed_.report = [this](const std::string& stage, double fraction) {
    if (fraction == 0.0) begin(stage);
    if (progress_.report) progress_.report(stage, fraction);
  };
}

void StageClock::lap() {
  const double seconds = watch_.lap();
  if (!stages_.empty()) stages_[current_].second += seconds;
}

void StageClock::begin(const std::string& stage) {
  lap();
  const auto place = std::find_if(stages_.begin(), stages_.end(),
                                  [&](const auto& known) { return known.first == stage; });
  current_ = static_cast<std::size_t>(place - stages_.begin());
  if (place == stages_.end()) stages_.emplace_back(stage, 0.0);
}

std::string StageClock::seconds() {
  lap();
  std::string text;
  double total = 0.0;
  for (const auto& [stage, seconds] : stages_) {
    text += fmt::format("{} {:.2f}, ", stage, seconds);
    total += seconds;
  }
  return text + fmt::format("total {:.2f}", total);
}

}  // namespace pcednet::app
