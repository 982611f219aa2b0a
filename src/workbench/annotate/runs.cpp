#include "workbench/annotate/runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"

namespace pcednet::annotate {
namespace {

auto position_of(auto& runs, int number) {
  return std::lower_bound(runs.begin(), runs.end(), number,
                          [](const Run& run, int wanted) { return run.record.number < wanted; });
}

}  // namespace

void Runs::remember(const RunRecord& record) {
  runs_.push_back({.record = record});
}

const Run* Runs::find(int number) const {
  const auto found = position_of(runs_, number);
  return found != runs_.end() && found->record.number == number ? &*found : nullptr;
}

std::shared_ptr<const Prediction> Runs::prediction(std::size_t cloud) const {
  const Run* run = shown();
  return run && cloud < run->predictions.size() ? run->predictions[cloud] : nullptr;
}

std::shared_ptr<const Prediction> Runs::settled_prediction(std::size_t cloud) const {
  const Run* run = shown();
  if (run && run->predictions.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("run {} is being trained again: wait for it", run->record.number));
  }
  return prediction(cloud);
}

void Runs::show(Run run) {
  for (Run& other : runs_) other.predictions.clear();
  shown_ = run.record.number;
  const auto place = position_of(runs_, *shown_);
  if (find(*shown_)) {
    *place = std::move(run);
  } else {
    runs_.insert(place, std::move(run));
  }
  ++version_;
}

void Runs::judge(int number, const HeldOut& held_out) {
  if (find(number)) position_of(runs_, number)->held_out = held_out;
}

void Runs::forget_start() {
  if (!find(0)) return;
  runs_.erase(runs_.begin());
  if (shown_ == 0) shown_.reset();
  ++version_;
}

void Runs::stop_awaiting() {
  if (!prediction(0)) shown_.reset();
}

std::vector<RunView> Runs::views() const {
  std::vector<RunView> views;
  for (const Run& run : runs_)
    views.push_back({run.record, run.record.number == shown_, run.held_out});
  return views;
}

std::optional<RunView> Runs::shown_view() const {
  const Run* run = shown();
  return run ? std::optional(RunView{run->record, true, run->held_out}) : std::nullopt;
}

}  // namespace pcednet::annotate
