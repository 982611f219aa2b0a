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

using Json = nlohmann::json;
using Lock = std::unique_lock<std::mutex>;

std::string now_as_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace

void Session::State::emit(const std::string& name, const Json& json) const {
  if (options.emit) options.emit(name, json.dump());
}

bool Session::State::is_void(std::uint64_t of_generation) const {
  const Lock lock(mutex);
  return stopping || generation != of_generation;
}

Progress Session::State::progress(std::uint64_t of_generation) {
  return {.report =
              [this](const std::string& name, double fraction) {
                {
                  const Lock lock(mutex);
                  stage = name;
                }
                emit("progress", {{"stage", name}, {"fraction", fraction}});
              },
          .cancelled = [this, of_generation] { return is_void(of_generation); }};
}

/// The worker's life: load, then train and restore as asked.
void Session::State::work() {
  try {
    load();
  } catch (const std::exception& error) {
    {
      const Lock lock(mutex);
      failure = std::current_exception();
      stage = error.what();
    }
    changed.notify_all();
    emit("problem", {{"message", error.what()}});
    return;
  }
  while (true) {
    Lock lock(mutex);
    while (!stopping && !restore && !(due && *due <= std::chrono::steady_clock::now())) {
      if (due) {
        const auto until = *due;  // may change while waiting
        changed.wait_until(lock, until);
      } else {
        changed.wait(lock);
      }
    }
    if (stopping) return;
    const std::uint64_t mine = generation;
    const auto wanted = std::exchange(restore, {});
    if (!wanted) due.reset();
    lock.unlock();
    try {
      wanted ? restore_once(*wanted, mine) : train_once(mine);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kCancelled) emit("problem", {{"message", error.what()}});
    } catch (const std::exception& error) {
      emit("problem", {{"message", error.what()}});
    }
  }
}

void Session::State::load() {
  const Progress reporter = {.report = progress(0).report, .cancelled = [this] {
                               const Lock lock(mutex);
                               return stopping;
                             }};
  auto loaded = load_scene(options.input, &reporter);
  auto first = describe_once(loaded->prepared, {}, options.cache_folder, &reporter);
  {
    const Lock lock(mutex);
    scene = std::move(loaded);
    described = std::move(first);
  }
  open_project();
  {
    const Lock lock(mutex);
    ready = true;
    stage = "ready";
  }
  changed.notify_all();
  emit("ready", Json::object());
  for (const auto* notes : {&scene->warnings, &scene->prepared.notes}) {
    for (const std::string& note : *notes) emit("problem", {{"message", note}});
  }
  if (!options.model.empty()) show_model(options.model);
}

/// Puts together what the project and the journal remember.
void Session::State::open_project() {
  std::vector<Record> saved;
  if (std::filesystem::exists(options.project)) {
    Project project = read_project(options.project);
    if (project.input.digest != scene->input.digest) {
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("{}: a project of {}, not of this {}", options.project.string(),
                              project.input.name, scene->input.name));
    }
    saved = std::move(project.records);
  }
  std::vector<Record> known = saved;
  const std::filesystem::path path = journal_of(options.project);
  auto opened = std::make_unique<Journal>(path, scene->input, known);
  for (std::size_t i = 0; i < std::min(saved.size(), known.size()); ++i) {
    if (to_line(saved[i]) != to_line(known[i])) {
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("{} and {} tell different stories: move one of them away",
                              options.project.string(), path.string()));
    }
  }
  for (std::size_t i = known.size(); i < saved.size(); ++i) {
    opened->append(saved[i]);
    known.push_back(saved[i]);
  }
  const Lock lock(mutex);
  Replayed end = replay(known, scene->input.points);
  journal = std::move(opened);
  labels = std::make_unique<Labels>(std::move(end.labels));
  settings = end.settings;
  for (const Record& record : known) {
    if (record.kind == Record::Kind::kStroke) {
      answers[record.id] = answer(0, record.points.size(), Json::array()).dump();
    }
  }
  records = std::move(known);
  labels_version = records.empty() ? 0 : 1;
  remember_runs(end);
}

/// Lists the runs of earlier starts. Models are not kept: that of the current one is made again,
/// the others' when they are asked for.
void Session::State::remember_runs(const Replayed& end) {
  for (const auto& [number, record] : end.runs) {
    if (end.run && number == end.run->number) {
      current_run = static_cast<int>(runs.size());
      restore = recorded_run = number;
    }
    runs.push_back({.record = record});
    next_run = number + 1;
  }
  const bool is_trained = !records.empty() && (records.back().kind == Record::Kind::kRun ||
                                               records.back().kind == Record::Kind::kRestore);
  if (settings.automatic && !is_trained) due = std::chrono::steady_clock::now();
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
  if (its.start != "random") start = options.load_model(its.start);
  const detect::EdgeModel* from = start ? &*start : nullptr;
  const auto rows = description(descriptor_of(from), mine);
  const Progress cancel = {.report = {}, .cancelled = [&] { return is_void(mine); }};
  // Epochs are judged by what is held out; with too little painted there is nothing to hold out.
  int epochs = 0;
  const auto on_epoch = [&](const nn::EpochReport& report) {
    facts.loss = report.training_loss;
    if (!report.validation_confusion.empty()) facts.held_out_accuracy = report.validation_accuracy;
    ++epochs;
    emit("training", {{"run", run.record.number},
                      {"epoch", report.epoch},
                      {"epochs", kEpochs},
                      {"loss", report.training_loss},
                      {"held_out_accuracy", optional_number(facts.held_out_accuracy)}});
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
    asked = std::exchange(asked_for, false);
    painted_classes = labels->classes();
    run.record = {.number = next_run, .records = records.size(), .settings = settings};
    const auto counts = labels->counts();
    run.record.facts.painted = counts[0] + counts[1] + counts[2];
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
  if (generation != mine || stopping) return;
  Record record;
  record.kind = Record::Kind::kRun;
  record.run = run.record;
  keep(std::move(record));
  next_run = run.record.number + 1;
  recorded_run = run.record.number;
  publish(std::move(run));
}

/// Gives a run of an earlier start the model that it had then.
bool Session::State::train_again(Run& run, std::uint64_t mine) {
  const RunFacts then = run.record.facts;
  try {
    std::optional<Labels> its;
    {
      const Lock lock(mutex);
      its = labels_of(run.record, records, scene->input.points);
    }
    if (!train(run, its->classes(), mine)) return false;
    const auto counts = its->counts();
    run.record.facts.painted = counts[0] + counts[1] + counts[2];
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    throw Error(error.kind(),
                fmt::format("run {} cannot be trained again: {}", run.record.number, error.what()));
  }
  if (!then.painted) return true;  // of the first version: nothing was known of it
  if (then.loss != run.record.facts.loss) {
    emit("problem", {{"message", fmt::format("run {} is not quite what it was: another version of "
                                             "pcednet or of the model it starts from made it",
                                             run.record.number)}});
  }
  run.record.facts = then;
  return true;
}

void Session::State::restore_once(int number, std::uint64_t mine) {
  Run run;
  {
    const Lock lock(mutex);
    run = *find_run(number);
  }
  const RunFacts then = run.record.facts;
  try {
    if (!run.model && !train_again(run, mine)) return;
    classify(run, mine);
  } catch (...) {
    const Lock lock(mutex);
    if (generation == mine && !prediction()) current_run = -1;  // nor can it be made again
    throw;
  }
  if (then.seconds_classify) run.record.facts.seconds_classify = then.seconds_classify;
  const Lock lock(mutex);
  if (generation != mine || stopping) return;
  if (number != recorded_run && number > 0) {
    Record record;
    record.kind = Record::Kind::kRestore;
    record.run.number = number;
    keep(std::move(record));
    recorded_run = number;
  }
  publish(std::move(run));
}

/// A run without training, number 0.
void Session::State::show_model(const std::string& name) {
  Run run;
  run.model = options.load_model(name);
  run.record = {.number = 0, .records = 0, .settings = settings};
  run.record.settings.start = name;
  RunFacts& facts = run.record.facts;
  facts = {.painted = 0, .classes = static_cast<int>(run.model->classes.size())};
  facts.seconds_train = 0;
  classify(run, 0);
  facts.time = now_as_text();
  const Lock lock(mutex);
  publish(std::move(run));
}

std::vector<Run>::iterator Session::State::find_run(int number) {
  const auto found =
      std::lower_bound(runs.begin(), runs.end(), number,
                       [](const Run& run, int wanted) { return run.record.number < wanted; });
  return found != runs.end() && found->record.number != number ? runs.end() : found;
}

void Session::State::publish(Run run) {
  // The answers of other runs are let go: their models can give them again.
  for (Run& other : runs) other.prediction.reset();
  auto found = find_run(run.record.number);
  if (found == runs.end()) {
    // The number of a model that is shown without training comes before all others.
    found = runs.insert(run.record.number == 0 ? runs.begin() : runs.end(), Run());
  }
  *found = std::move(run);
  current_run = static_cast<int>(found - runs.begin());
  ++prediction_version;
  const auto& counts = found->prediction->result.counts;
  const RunFacts& facts = found->record.facts;
  emit("prediction", {{"prediction_version", prediction_version},
                      {"run", found->record.number},
                      {"counts", {counts.non_edge, counts.smooth, counts.sharp}},
                      {"seconds_train", optional_number(facts.seconds_train)},
                      {"seconds_classify", optional_number(facts.seconds_classify)},
                      {"held_out_accuracy", optional_number(facts.held_out_accuracy)}});
}

}  // namespace pcednet::annotate
