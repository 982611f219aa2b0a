#include "pcednet/core/error.h"
#include "pcednet/lines/find_lines.h"
#include "workbench/annotate/kept_decisions.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {

using Lock = std::unique_lock<std::mutex>;

LinesView Session::lines(std::size_t cloud) const {
  const Lock lock(state_->mutex);
  state_->check_cloud(cloud);
  return {state_->reviews[cloud], cloud, state_->scenes[cloud]};
}

void Session::find_lines(std::size_t cloud) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_cloud(cloud);
  if (!s.runs.settled_prediction(cloud)) {
    throw Error(ErrorKind::kInsufficient, "there is no prediction yet: paint and train");
  }
  if (!s.painting->classes().has_edges()) {
    throw Error(ErrorKind::kInsufficient,
                "lines are of edges, which this project's classes are not");
  }
  s.orders.find_lines.insert(cloud);
  s.set_searching(cloud, true);
  s.changed.notify_all();
}

void Session::decide(const LinesDecided& wanted) {
  const Lock lock(state_->mutex);
  state_->check_cloud(wanted.cloud);
  LineReview decided = state_->reviews[wanted.cloud];
  annotate::decide(decided, wanted);
  keep_decisions(decisions_of(state_->options.project, wanted.cloud), decided);
  state_->reviews[wanted.cloud] = std::move(decided);
  state_->emit(wanted);
}

void Session::State::set_searching(std::size_t cloud, bool on) {
  LineReview& review = reviews[cloud];
  if (review.is_searching == on) return;
  review.is_searching = on;
  emit(LinesChanged{.cloud = cloud, .version = review.version, .is_searching = on});
}

void Session::State::find_lines_once(std::size_t cloud, std::uint64_t mine) {
  std::shared_ptr<const Prediction> prediction;
  int version = 0;
  {
    const Lock lock(mutex);
    prediction = runs.prediction(cloud);
    version = runs.version();
  }
  try {
    const Progress reporter = progress(mine);
    const detect::PreparedCloud& prepared = scenes[cloud]->prepared;
    std::vector<std::uint8_t> edges = prediction->result.classes;
    for (std::uint8_t& id : edges) {
      if (id > kBoundary && id != kUnlabelled) id = kNonEdge;
    }
    auto curves = std::make_shared<std::vector<lines::Curve>>(
        lines::find_lines({.positions = prepared.positions,
                           .normals = prepared.normals,
                           .classes = edges,
                           .p_sharp = prediction->result.p_sharp,
                           .p_smooth = prediction->result.p_smooth,
                           .curve = prepared.curve},
                          {}, &reporter));
    const Lock lock(mutex);
    if (orders.generation != mine || orders.stopping) return;
    LineReview& review = reviews[cloud];
    const auto kept = decisions_of(options.project, cloud);
    std::error_code ignored;
    if (review.version > 0) std::filesystem::remove(kept, ignored);  // the user begins afresh
    review.decisions = kept_decisions(kept, *curves);
    review.curves = std::move(curves);
    review.prediction_version = version;
    ++review.version;
    set_searching(cloud, orders.find_lines.contains(cloud));
  } catch (...) {
    const Lock lock(mutex);
    if (orders.generation == mine) set_searching(cloud, false);
    throw;
  }
}

}  // namespace pcednet::annotate
