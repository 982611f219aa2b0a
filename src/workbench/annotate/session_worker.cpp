#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "workbench/annotate/learn.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {
namespace {

using Lock = std::unique_lock<std::mutex>;

std::string now_as_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace

void Session::State::emit(const Event& event) const {
  if (options.emit) options.emit(event);
}

bool Session::State::is_void(std::uint64_t of_generation) const {
  const Lock lock(mutex);
  return orders.stopping || orders.generation != of_generation;
}

Progress Session::State::progress(std::uint64_t of_generation) {
  return {.report =
              [this](const std::string& name, double fraction) {
                {
                  const Lock lock(mutex);
                  loading.stage = name;
                }
                emit(StageProgress{name, fraction});
              },
          .cancelled = [this, of_generation] { return is_void(of_generation); }};
}

/// The worker's life: load, then restore, train and find lines as asked.
void Session::State::work() {
  try {
    load();
  } catch (const std::exception& error) {
    {
      const Lock lock(mutex);
      loading.failure = std::current_exception();
      loading.stage = error.what();
    }
    changed.notify_all();
    emit(Problem{error.what()});
    return;
  }
  while (true) {
    Lock lock(mutex);
    wait_for_orders(lock);
    if (orders.stopping) return;
    const std::function<void()> work = next_work();
    lock.unlock();
    try {
      work();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kCancelled) emit(Problem{error.what()});
    } catch (const std::exception& error) {
      emit(Problem{error.what()});
    }
  }
}

bool Session::State::is_training_due() const {
  return orders.train_at && *orders.train_at <= std::chrono::steady_clock::now();
}

/// Takes the first of the orders.
std::function<void()> Session::State::next_work() {
  const std::uint64_t mine = orders.generation;
  if (const auto wanted = std::exchange(orders.restore, {})) {
    return [this, mine, number = *wanted] { restore_once(number, mine); };
  }
  if (is_training_due()) {
    orders.train_at.reset();
    return [this, mine] { train_once(mine); };
  }
  orders.find_lines = false;
  return [this, mine] { find_lines_once(mine); };
}

void Session::State::wait_for_orders(std::unique_lock<std::mutex>& lock) {
  while (!orders.stopping && !orders.restore && !orders.find_lines && !is_training_due()) {
    if (orders.train_at) {
      const auto until = *orders.train_at;  // may change while waiting
      changed.wait_until(lock, until);
    } else {
      changed.wait(lock);
    }
  }
}

void Session::State::load() {
  const Progress reporter = {.report = progress(0).report, .cancelled = [this] {
                               const Lock lock(mutex);
                               return orders.stopping;
                             }};
  auto loaded = load_scene(options.input, &reporter);
  {
    const Lock lock(mutex);
    scene = std::move(loaded);
  }
  open_project();
  auto first = describe_once(scene->prepared, {}, options.cache_folder, &reporter);
  {
    const Lock lock(mutex);
    described = std::move(first);
    loading.is_done = true;
    loading.stage = "ready";
  }
  changed.notify_all();
  emit(Ready{});
  for (const auto* notes : {&scene->warnings, &scene->prepared.notes}) {
    for (const std::string& note : *notes) emit(Problem{note});
  }
  if (!options.model.empty()) show_model(options.model);
}

void Session::State::open_project() {
  Painting opened(options.project, scene->input);
  const Lock lock(mutex);
  painting = std::move(opened);
  labels_version = painting->records().empty() ? 0 : 1;
  for (const Record& record : painting->records()) {
    if (record.kind != Record::Kind::kStroke) continue;
    Painted& answer = answers[record.id] = standing();
    answer.changed = record.points.size();
  }
  remember_runs();
  loading.is_accepted = true;
}

/// Lists the runs of earlier starts. Models are not kept: that of the current one is made again,
/// the others' when they are asked for.
void Session::State::remember_runs() {
  for (const auto& [number, record] : painting->now().runs) runs.remember(record);
  if (const int shown = painting->shown_run(); shown > 0) {
    runs.await(shown);
    orders.restore = shown;
  }
  if (painting->settings().automatic && !painting->is_trained()) {
    orders.train_at = std::chrono::steady_clock::now();
  }
}

std::shared_ptr<const Described> Session::State::description(
    const gls::ScaleSpaceOptions& descriptor, std::uint64_t of_generation) {
  std::shared_ptr<const Described> known;
  {
    const Lock lock(mutex);
    known = described;
  }
  if (known->descriptor == descriptor) return known;
  const Progress reporter = progress(of_generation);
  auto other = describe_once(scene->prepared, descriptor, options.cache_folder, &reporter);
  const Lock lock(mutex);
  described = other;
  return other;
}

/// Gives `run` its model, from the points painted and the settings of its record. False if it was
/// cancelled.
bool Session::State::train(Run& run, std::span<const std::uint8_t> painted_classes,
                           std::uint64_t mine) {
  RunFacts& facts = run.record.facts;
  const Settings& its = run.record.settings;
  std::optional<detect::EdgeModel> start;
  if (its.start != kRandomStart) start = options.load_model(its.start);
  const detect::EdgeModel* from = start ? &*start : nullptr;
  const auto rows = description(descriptor_of(from), mine);
  const Progress cancel = {.report = {}, .cancelled = [&] { return is_void(mine); }};
  // Epochs are judged by what is held out; with too little painted there is nothing to hold out.
  int epochs = 0;
  const auto on_epoch = [&](const nn::EpochReport& report) {
    facts.loss = report.training_loss;
    if (!report.validation_confusion.empty()) facts.held_out_accuracy = report.validation_accuracy;
    ++epochs;
    emit(EpochDone{.run = run.record.number,
                   .epoch = report.epoch,
                   .epochs = kEpochs,
                   .loss = report.training_loss,
                   .held_out_accuracy = facts.held_out_accuracy});
  };
  Stopwatch watch;
  auto trained =
      learn(options.input.stem().string(), *rows, painted_classes, its, from, on_epoch, &cancel);
  if (trained.cancelled || epochs == 0) return false;
  facts.seconds_train = watch.lap();
  facts.classes = static_cast<int>(trained.model.classes.size());
  run.model = std::move(trained.model);
  return true;
}

void Session::State::classify(Run& run, std::uint64_t mine) {
  const auto rows = description(run.model->descriptor, mine);
  Stopwatch watch;
  run.prediction = predict(*scene, *rows, *run.model);
  run.record.facts.seconds_classify = watch.lap();
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
                  .settings = painting->settings()};
    run.record.facts.painted = painting->labels().painted();
  }
  try {
    classes_to_learn(painted_classes, run.record.settings);
  } catch (const Error&) {
    if (asked) throw;
    return;  // not yet: the user is still painting
  }
  if (!train(run, painted_classes, mine)) return;
  classify(run, mine);
  run.record.facts.time = now_as_text();
  const Lock lock(mutex);
  if (orders.generation != mine || orders.stopping) return;
  Record record;
  record.kind = Record::Kind::kRun;
  record.run = run.record;
  painting->add(std::move(record));
  show(std::move(run));
}

/// Gives a run of an earlier start the model that it had then.
bool Session::State::train_again(Run& run, std::uint64_t mine) {
  const RunFacts then = run.record.facts;
  try {
    std::optional<Labels> its;
    {
      const Lock lock(mutex);
      its = labels_of(run.record, painting->records(), scene->input.points);
    }
    if (!train(run, its->classes(), mine)) return false;
    run.record.facts.painted = its->painted();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    throw Error(error.kind(),
                fmt::format("run {} cannot be trained again: {}", run.record.number, error.what()));
  }
  if (!then.painted) return true;  // of the first version: nothing was known of it
  if (then.loss != run.record.facts.loss) {
    emit(
        Problem{fmt::format("run {} cannot be reproduced exactly: another version of pcednet or of "
                            "its start model made it",
                            run.record.number)});
  }
  run.record.facts = then;
  return true;
}

void Session::State::restore_once(int number, std::uint64_t mine) {
  Run run;
  {
    const Lock lock(mutex);
    run = *runs.find(number);
  }
  const RunFacts then = run.record.facts;
  try {
    if (!run.model && !train_again(run, mine)) return;
    classify(run, mine);
  } catch (...) {
    const Lock lock(mutex);
    if (orders.generation == mine) runs.stop_awaiting();  // nor can it be made again
    throw;
  }
  if (then.seconds_classify) run.record.facts.seconds_classify = then.seconds_classify;
  const Lock lock(mutex);
  if (orders.generation != mine || orders.stopping) return;
  if (number != painting->shown_run() && number > 0) {
    Record record;
    record.kind = Record::Kind::kRestore;
    record.run.number = number;
    painting->add(std::move(record));
  }
  show(std::move(run));
}

/// A run without training, number 0.
void Session::State::show_model(const std::string& name) {
  Run run;
  run.model = options.load_model(name);
  {
    const Lock lock(mutex);
    run.record = {.number = 0, .records = 0, .settings = painting->settings()};
  }
  run.record.settings.start = name;
  RunFacts& facts = run.record.facts;
  facts = {.painted = 0, .classes = static_cast<int>(run.model->classes.size())};
  facts.seconds_train = 0;
  classify(run, 0);
  facts.time = now_as_text();
  const Lock lock(mutex);
  show(std::move(run));
}

void Session::State::show(Run run) {
  const auto& counts = run.prediction->result.counts;
  Predicted predicted{.run = run.record.number,
                      .counts = {counts.non_edge, counts.smooth, counts.sharp, counts.boundary},
                      .facts = run.record.facts};
  runs.show(std::move(run));
  predicted.prediction_version = runs.version();
  emit(predicted);
}

}  // namespace pcednet::annotate
