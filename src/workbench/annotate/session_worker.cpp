#include <algorithm>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "workbench/annotate/learn/outputs.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {
namespace {

using Lock = std::unique_lock<std::mutex>;

}  // namespace

void Session::State::emit(const Event& event) const {
  if (options.emit) options.emit(event);
}

bool Session::State::is_void(std::uint64_t of_generation) const {
  const Lock lock(mutex);
  return orders.stopping || orders.generation != of_generation;
}

Progress Session::State::cancellation(std::uint64_t of_generation) const {
  return {.report = {}, .cancelled = [this, of_generation] { return is_void(of_generation); }};
}

Progress Session::State::progress(std::uint64_t of_generation) {
  Progress progress = cancellation(of_generation);
  progress.report = [this](const std::string& name, double fraction) {
    {
      const Lock lock(mutex);
      loading.stage = name;
    }
    emit(StageProgress{name, fraction});
  };
  return progress;
}

/// The worker's loop: load, then restore, train, find lines and judge as ordered.
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
  if (!orders.find_lines.empty()) {
    const auto order = *orders.find_lines.begin();
    orders.find_lines.erase(order.first);
    return [this, mine, order] { find_lines_once(order.first, order.second, mine); };
  }
  orders.judge = false;
  return [this, mine] { judge_once(mine); };
}

void Session::State::wait_for_orders(std::unique_lock<std::mutex>& lock) {
  while (!orders.stopping && !orders.restore && orders.find_lines.empty() && !orders.judge &&
         !is_training_due()) {
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
  for (std::size_t k = 0; k <= options.further.size(); ++k) {
    auto loaded = load_scene(input_of(k), &reporter);
    const Lock lock(mutex);
    firsts.push_back(k == 0 ? 0 : firsts.back() + scenes.back()->cloud.size());
    scenes.push_back(std::move(loaded));
  }
  open_project();
  std::vector<std::shared_ptr<const Described>> first;
  const gls::ScaleSpaceOptions descriptor = first_descriptor();
  for (const auto& scene : scenes) {
    first.push_back(describe_once(scene->prepared, descriptor, options.cache_folder, &reporter));
  }
  {
    const Lock lock(mutex);
    described = std::move(first);
    reviews.resize(scenes.size());
    loading.is_done = true;
    loading.stage = "ready";
  }
  changed.notify_all();
  Ready ready;
  for (const auto& scene : scenes) {
    for (const std::string& note : notes_of(*scene)) {
      ready.notes.push_back(scene->input.name + ": " + note);
    }
  }
  emit(ready);
}

/// The descriptor of the project's start model.
gls::ScaleSpaceOptions Session::State::first_descriptor() const {
  std::string name;
  {
    const Lock lock(mutex);
    name = painting->settings().start;
  }
  return name == kRandomStart ? gls::ScaleSpaceOptions{} : options.load_model(name).descriptor;
}

/// A new project starts from the model of the options; that of an existing one is replaced only on
/// request.
void Session::State::choose_start(bool is_new) {
  if (!is_new && !options.is_model_wanted) return;
  Settings wanted = painting->settings();
  wanted.start = options.model.empty() ? kRandomStart : options.model;
  if (!begins_from(wanted.start)) {
    if (options.is_model_wanted) {
      check_start(options.load_model(wanted.start), wanted.start, painting->classes().table);
    }
    wanted.start = kRandomStart;
  }
  fit_to_start(wanted);
  if (wanted == painting->settings()) return;
  painting->add({.kind = Record::Kind::kSettings, .settings = wanted});
}

/// The start that the project has may be chosen again.
void Session::State::offer(const std::string& start_named) {
  auto& offered = options.starts;
  if (start_named == kRandomStart) return;
  if (std::find(offered.begin(), offered.end(), start_named) == offered.end()) {
    offered.push_back(start_named);
  }
}

/// A start without smooth-edge learns two classes, whatever was chosen.
void Session::State::fit_to_start(Settings& settings) const {
  if (settings.start == kRandomStart) return;
  if (!knows_smooth_edge(options.load_model(settings.start))) settings.classes = 2;
}

/// Whether training may start from that model, or from nothing.
bool Session::State::begins_from(const std::string& model) const {
  return model == kRandomStart || can_start(options.load_model(model), painting->classes().table);
}

/// A project has the classes that the user names, a new one otherwise those of its model.
void Session::State::choose_classes() {
  const ProjectClasses& now = painting->classes();
  ProjectClasses wanted = now;
  if (options.classes) {
    wanted = wanted_classes(now, *options.classes);
  } else if (painting->records().empty() && !options.model.empty()) {
    wanted = {.table = options.load_model(options.model).table};
  }
  if (wanted == now) return;
  check_change(now, wanted, painting->labels().counts(), painting->now().ever_painted);
  Record record{.kind = Record::Kind::kClasses, .classes = std::move(wanted)};
  painting->add(std::move(record));
}

void Session::State::open_project() {
  Painting opened(options.project, inputs());
  const Lock lock(mutex);
  painting = std::move(opened);
  labels_version = painting->records().empty() ? 0 : 1;
  const Painted now = standing();
  for (const Record& record : painting->records()) {
    if (record.kind != Record::Kind::kStroke) continue;
    Painted& answer = answers[record.id] = now;
    answer.changed = record.points.size();
  }
  const bool is_new = painting->records().empty();
  choose_classes();
  choose_start(is_new);
  offer(painting->settings().start);
  remember_runs();
  loading.is_accepted = true;
}

/// Lists the runs of earlier starts. Models are not kept: the current one is retrained, the others
/// on demand.
void Session::State::remember_runs() {
  for (const auto& [number, record] : painting->now().runs) runs.remember(record);
  if (const int shown = painting->shown_run(); shown > 0) {
    runs.await(shown);
    orders.restore = shown;
  }
  const bool is_due = painting->settings().automatic || painting->labels().painted() == 0;
  if (is_due && !painting->is_trained()) orders.train_at = std::chrono::steady_clock::now();
}

/// The descriptions of the first `clouds` clouds.
std::vector<std::shared_ptr<const Described>> Session::State::descriptions(
    const gls::ScaleSpaceOptions& descriptor, std::size_t clouds, std::uint64_t of_generation) {
  std::vector<std::shared_ptr<const Described>> wanted;
  {
    const Lock lock(mutex);
    wanted.assign(described.begin(), described.begin() + static_cast<std::ptrdiff_t>(clouds));
  }
  const Progress reporter = progress(of_generation);
  for (std::size_t k = 0; k < clouds; ++k) {
    if (wanted[k]->descriptor == descriptor) continue;
    wanted[k] = describe_once(scenes[k]->prepared, descriptor, options.cache_folder, &reporter);
    const Lock lock(mutex);
    described[k] = wanted[k];
  }
  return wanted;
}

std::filesystem::path Session::State::input_of(std::size_t cloud) const {
  return cloud == 0 ? options.input : options.further[cloud - 1];
}

/// A further input is named relative to the first, unless it is far away.
Inputs Session::State::inputs() const {
  Inputs all;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    all.push_back(scenes[k]->input);
    if (k == 0) continue;
    const std::filesystem::path relative =
        input_of(k).lexically_proximate(options.input.parent_path());
    all[k].name = as_utf8(relative.string());
  }
  return all;
}

}  // namespace pcednet::annotate
