#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "workbench/annotate/learn/learn.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {
namespace {

using Lock = std::unique_lock<std::mutex>;

std::string now_as_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace

/// The start of a training under `settings`; null: random weights.
std::shared_ptr<const Start> Session::State::start_of(const Settings& settings, std::size_t clouds,
                                                      std::uint64_t mine) {
  if (settings.start == kRandomStart) return {};
  if (start && start_name == settings.start && start_classes == settings.classes &&
      start_clouds == clouds) {
    return start;
  }
  detect::EdgeModel model = with_classes(options.load_model(settings.start), settings.classes);
  check_start(model, settings.start, table());
  const auto rows = descriptions(model.descriptor, clouds, mine);
  const Progress cancel = cancellation(mine);
  start = std::make_shared<const Start>(make_start(std::move(model), subject_of(rows), &cancel));
  start_name = settings.start;
  start_classes = settings.classes;
  start_clouds = clouds;
  return start;
}

Subject Session::State::subject_of(std::span<const std::shared_ptr<const Described>> rows) const {
  Subject subject{.clouds = {}, .table = table()};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const detect::PreparedCloud& prepared = scenes[k]->prepared;
    subject.clouds.push_back({*rows[k], prepared.positions, prepared.curve});
  }
  return subject;
}

ClassTable Session::State::table() const {
  const Lock lock(mutex);
  return painting->classes().table;
}

/// The predictions of `model`: `found` for the first clouds, computed for the others.
Predictions Session::State::predictions_of(const detect::EdgeModel& model,
                                           const detect::Classification& found,
                                           std::uint64_t mine) {
  const Progress cancel = cancellation(mine);
  Predictions predictions;
  std::vector<std::shared_ptr<const Described>> rows;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const std::size_t points = scenes[k]->cloud.size();
    const bool is_known = firsts[k] < found.classes.size();
    if (!is_known && rows.empty()) rows = descriptions(model.descriptor, scenes.size(), mine);
    predictions.push_back(make_prediction(
        *scenes[k], model,
        is_known
            ? part_of(found, firsts[k], points)
            : detect::classify(rows[k]->cloud, scenes[k]->prepared.positions, model, &cancel)));
  }
  return predictions;
}

/// Gives `run` its model and prediction, from the points painted and the settings of its record.
/// False if it was cancelled.
bool Session::State::train(Run& run, std::span<const std::uint8_t> painted_classes,
                           std::uint64_t mine) {
  RunFacts& facts = run.record.facts;
  const Settings& its = run.record.settings;
  const std::size_t clouds = std::min(run.record.clouds, scenes.size());
  const auto from = start_of(its, clouds, mine);
  const auto rows = descriptions(descriptor_of(from ? &from->model : nullptr), clouds, mine);
  const Progress cancel = cancellation(mine);
  painted_classes = painted_classes.first(firsts[clouds - 1] + scenes[clouds - 1]->cloud.size());
  const auto on_epoch = [&](const nn::EpochReport& report) {
    const int epochs = epochs_of(from.get());
    emit(EpochDone{.run = run.record.number,
                   .epoch = report.epoch,
                   .epochs = epochs,
                   .is_context = report.epoch > epochs - context_epochs_of(from.get()),
                   .loss = report.training_loss});
  };
  Stopwatch watch;
  Adapted learnt = learn(options.input.stem().string(), subject_of(rows), painted_classes, its,
                         from.get(), on_epoch, &cancel);
  if (learnt.cancelled) return false;
  facts.seconds_train = watch.lap() - learnt.seconds_classify;
  facts.seconds_classify = learnt.seconds_classify;
  facts.loss = learnt.loss;
  facts.classes = static_cast<int>(learnt.model.classes.size());
  run.predictions = predictions_of(learnt.model, learnt.found, mine);
  run.model = std::move(learnt.model);
  return true;
}

void Session::State::train_once(std::uint64_t mine) {
  Run run;
  std::vector<std::uint8_t> painted_classes;
  bool asked = false;
  {
    const Lock lock(mutex);
    asked = std::exchange(orders.asked_for, false);
    painted_classes = painting->labels().classes();
    run.record = {.number = painting->next_run(),
                  .records = painting->records().size(),
                  .settings = painting->settings(),
                  .clouds = scenes.size()};
    run.record.facts.painted = painting->labels().painted();
  }
  try {
    check_can_learn(painted_classes, run.record.settings, table());
  } catch (const Error&) {
    if (asked) throw;
    // Too few points yet: the user is still painting. The start has predictions even without any.
    if (run.record.settings.start != kRandomStart) show_start(run.record.settings, mine);
    return;
  }
  if (!train(run, painted_classes, mine)) return;
  run.record.facts.time = now_as_text();
  const Lock lock(mutex);
  if (orders.generation != mine || orders.stopping) return;
  painting->add({.kind = Record::Kind::kRun, .run = run.record});
  show(std::move(run));
}

/// Restores the model of a run of an earlier start.
bool Session::State::train_again(Run& run, std::uint64_t mine) {
  const RunFacts then = run.record.facts;
  bool trained = false;
  with_name_in_errors(fmt::format("run {} cannot be trained again", run.record.number), [&] {
    std::optional<Labels> its;
    {
      const Lock lock(mutex);
      its = labels_of(run.record, painting->records(), annotate::points_of(inputs()));
    }
    trained = train(run, its->classes(), mine);
    if (trained) run.record.facts.painted = its->painted();
  });
  if (!trained) return false;
  if (!then.painted) return true;  // of the first version, without facts
  const double loss = run.record.facts.loss.value_or(0);
  run.record.facts = then;
  if (is_another(run.record, loss)) emit(Problem{not_reproduced(run.record.number)});
  return true;
}

/// Classifies with a model that was trained before.
void Session::State::classify(Run& run, std::uint64_t mine) {
  const auto rows = descriptions(run.model->descriptor, scenes.size(), mine);
  const Progress cancel = cancellation(mine);
  Stopwatch watch;
  const auto found = annotate::classify(subject_of(rows), *run.model, &cancel);
  if (!run.record.facts.seconds_classify) run.record.facts.seconds_classify = watch.lap();
  run.predictions = predictions_of(*run.model, found, mine);
}

void Session::State::restore_once(int number, std::uint64_t mine) {
  Run run;
  {
    const Lock lock(mutex);
    const Run* found = runs.find(number);
    if (!found) return;  // forgotten since it was asked for
    run = *found;
  }
  try {
    if (number == 0) return show_start(run.record.settings, mine);
    if (run.model) {
      classify(run, mine);
    } else if (!train_again(run, mine)) {
      return;
    }
  } catch (...) {
    const Lock lock(mutex);
    if (orders.generation == mine) runs.stop_awaiting();  // it cannot be restored either
    throw;
  }
  const Lock lock(mutex);
  if (orders.generation != mine || orders.stopping) return;
  if (number != painting->shown_run()) {
    painting->add({.kind = Record::Kind::kRestore, .run = {.number = number}});
  }
  show(std::move(run));
}

/// Shows the predictions of the start itself: a run without training, number 0. They are those of
/// `classify`: the model's experts decide on clouds of their kinds. With own classes no model has
/// experts, so there the start's networks decide.
void Session::State::show_start(const Settings& settings, std::uint64_t mine) {
  Stopwatch watch;
  Run run{.record = {.number = 0, .records = 0, .settings = settings}};
  detect::Classification found;
  if (has_own_classes(table())) {
    const auto from = start_of(settings, scenes.size(), mine);
    run.model = from->model;
    found = from->answer;
  } else {
    run.model = with_classes(options.load_model(settings.start), settings.classes);
    check_start(*run.model, settings.start, table());
  }
  run.predictions = predictions_of(*run.model, found, mine);
  run.record.facts = {.painted = 0,
                      .classes = static_cast<int>(run.model->classes.size()),
                      .seconds_train = 0,
                      .seconds_classify = watch.lap(),
                      .time = now_as_text()};
  {
    const Lock lock(mutex);
    if (orders.generation != mine || orders.stopping) return;
    show(std::move(run));
  }
  start_of(settings, scenes.size(), mine);  // so that the first training need not wait for it
}

void Session::State::show(Run run) {
  Predicted predicted{.run = run.record.number, .facts = run.record.facts};
  predicted.counts.resize(painting->classes().table.size());
  for (const auto& prediction : run.predictions) {
    for (const std::uint8_t id : prediction->result.classes) {
      if (id < predicted.counts.size()) ++predicted.counts[id];
    }
  }
  orders.judge = run.record.number > 0 && !run.held_out;
  runs.show(std::move(run));
  predicted.prediction_version = runs.version();
  predicted.is_out_of_date = is_out_of_date();
  emit(predicted);
}

/// Evaluates the shown run on held-out strokes, once nothing else is to be done.
void Session::State::judge_once(std::uint64_t mine) {
  RunRecord record;
  std::optional<Labels> its;
  {
    const Lock lock(mutex);
    const Run* shown = runs.shown();
    if (!shown || shown->record.number == 0 || shown->held_out) return;
    record = shown->record;
    its = labels_of(record, painting->records(), annotate::points_of(inputs()));
  }
  const std::size_t clouds = std::min(record.clouds, scenes.size());
  const auto from = start_of(record.settings, clouds, mine);
  const auto rows = descriptions(descriptor_of(from ? &from->model : nullptr), clouds, mine);
  const Progress cancel = cancellation(mine);
  const HeldOut held_out = hold_out(subject_of(rows), *its, record.settings, from.get(), &cancel);
  const Lock lock(mutex);
  runs.judge(record.number, held_out);
  emit(Judged{record.number, held_out});
}

}  // namespace pcednet::annotate
