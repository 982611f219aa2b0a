#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/stopwatch.h"

namespace pcednet::app {

/// The seconds of each stage of work, under the names that the work reports.
class StageClock {
 public:
  /// Hands every report on to `progress`.
  explicit StageClock(Progress progress);
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  /// For the work to be timed; valid as long as the clock.
  const Progress& progress() const { return timed_; }

  /// Counts the time from here on for `stage`.
  void begin(const std::string& stage);

  /// "read 0.12, describe 3.40, total 3.52", in the order in which the stages first began.
  std::string seconds();

 private:
  void lap();

  Progress progress_, timed_;
  Stopwatch watch_ = {};
  std::vector<std::pair<std::string, double>> stages_ = {};
  std::size_t current_ = 0;
};

}  // namespace pcednet::app
