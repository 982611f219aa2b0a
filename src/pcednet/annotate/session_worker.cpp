#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "pcednet/annotate/learn.h"
#include "pcednet/annotate/session_state.h"
#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"

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
    const auto wanted = std::exchange(restore, {});
    if (!wanted) due.reset();
    lock.unlock();
    try {
      wanted ? restore_once(*wanted) : train_once();
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
  std::filesystem::path path = options.project;
  auto opened = std::make_unique<Journal>(path += ".journal", scene->input, known);
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
    if (record.kind == Record::Kind::kRun) next_run = std::max(next_run, record.run.number + 1);
  }
  records = std::move(known);
  labels_version = records.empty() ? 0 : 1;
  // A model is not kept, but it comes back as it was.
  if (settings.automatic || end.run) due = std::chrono::steady_clock::now();
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

void Session::State::train_once() {
  Run run;
  std::vector<std::uint8_t> painted_classes;
  std::uint64_t mine = 0;
  bool asked = false;
  {
    const Lock lock(mutex);
    mine = generation;
    asked = std::exchange(asked_for, false);
    painted_classes = labels->classes();
    run.record = {.number = next_run, .records = records.size(), .settings = settings};
    const auto counts = labels->counts();
    run.painted = counts[0] + counts[1] + counts[2];
  }
  try {
    classes_to_learn(painted_classes, run.record.settings);
  } catch (const Error&) {
    if (asked) throw;
    return;  // not yet: the user is still painting
  }
  std::optional<detect::EdgeModel> start;
  if (run.record.settings.start != "random") start = options.load_model(run.record.settings.start);
  const detect::EdgeModel* from = start ? &*start : nullptr;
  const auto rows = description(descriptor_of(from), mine);
  const Progress cancel = {.report = {}, .cancelled = [&] { return is_void(mine); }};
  // Epochs are judged by what is held out; with too little painted there is nothing to hold out.
  int epochs = 0;
  const auto on_epoch = [&](const nn::EpochReport& report) {
    run.loss = report.training_loss;
    if (!report.validation_confusion.empty()) run.held_out_accuracy = report.validation_accuracy;
    ++epochs;
    emit("training",
         {{"run", run.record.number},
          {"epoch", report.epoch},
          {"epochs", kEpochs},
          {"loss", report.training_loss},
          {"held_out_accuracy", run.held_out_accuracy ? Json(*run.held_out_accuracy) : Json()}});
  };
  Stopwatch watch;
  auto trained = learn(options.input.stem().string(), *rows, painted_classes, run.record.settings,
                       from, on_epoch, &cancel);
  if (trained.cancelled || epochs == 0) return;
  run.seconds_train = watch.lap();
  run.model = trained.model;
  run.prediction = predict(*rows, std::move(trained.model));
  run.seconds_classify = watch.lap();
  run.time = now_as_text();
  const Lock lock(mutex);
  if (generation != mine || stopping) return;
  Record record;
  record.kind = Record::Kind::kRun;
  record.run = run.record;
  keep(std::move(record));
  next_run = run.record.number + 1;
  publish(std::move(run));
}

void Session::State::restore_once(int number) {
  Run run;
  std::uint64_t mine = 0;
  {
    const Lock lock(mutex);
    mine = generation;
    const auto found = std::find_if(runs.begin(), runs.end(),
                                    [&](const Run& r) { return r.record.number == number; });
    run = *found;
  }
  Stopwatch watch;
  run.prediction = predict(*description(run.model.descriptor, mine), run.model);
  run.seconds_classify = watch.lap();
  const Lock lock(mutex);
  if (run.record.number > 0) {
    Record record;
    record.kind = Record::Kind::kRestore;
    record.run.number = number;
    keep(std::move(record));
  }
  publish(std::move(run));
}

/// A run without training, number 0.
void Session::State::show_model(const std::string& name) {
  Run run;
  run.model = options.load_model(name);
  run.record = {.number = 0, .records = 0, .settings = settings};
  run.record.settings.start = name;
  Stopwatch watch;
  run.prediction = predict(*description(run.model.descriptor, 0), run.model);
  run.seconds_classify = watch.lap();
  run.time = now_as_text();
  const Lock lock(mutex);
  publish(std::move(run));
}

void Session::State::publish(Run run) {
  // The answers of other runs are let go: their models can give them again.
  for (Run& other : runs) other.prediction.reset();
  auto found = std::find_if(runs.begin(), runs.end(),
                            [&](const Run& r) { return r.record.number == run.record.number; });
  if (found == runs.end()) found = runs.insert(runs.end(), Run());
  *found = std::move(run);
  current_run = static_cast<int>(found - runs.begin());
  ++prediction_version;
  const auto& counts = found->prediction->result.counts;
  emit("prediction", {{"prediction_version", prediction_version},
                      {"run", found->record.number},
                      {"counts", {counts.non_edge, counts.smooth, counts.sharp}},
                      {"seconds_train", found->seconds_train},
                      {"seconds_classify", found->seconds_classify},
                      {"held_out_accuracy",
                       found->held_out_accuracy ? Json(*found->held_out_accuracy) : Json()}});
}

}  // namespace pcednet::annotate
