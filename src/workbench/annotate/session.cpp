#include "workbench/annotate/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/formats/write_cloud.h"
#include "workbench/annotate/learn/learn.h"
#include "workbench/annotate/learn/outputs.h"
#include "workbench/annotate/scene/not_found.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {

namespace fs = std::filesystem;
using Lock = std::unique_lock<std::mutex>;

namespace {

/// The delay of training after a stroke: longer than the repeat interval of a held undo key. Mouse
/// strokes follow each other more slowly; they cancel a training.
constexpr std::chrono::milliseconds kPause{50};

/// The nodes that hold the points, ascending.
std::vector<std::uint32_t> nodes_with(std::span<const std::uint32_t> points, std::size_t first,
                                      const Layout& layout) {
  std::set<std::uint32_t> nodes;
  std::uint32_t last = kNoNode;
  for (const std::uint32_t point : points) {
    const std::uint32_t node = layout.node_of[point - first];
    if (node != last && node != kNoNode) nodes.insert(last = node);
  }
  return {nodes.begin(), nodes.end()};
}

/// The points that a stroke covers. Throws Error(kUsage) if it is of a class of the input that is
/// not the project's class of that number.
std::vector<std::uint32_t> points_under(const Stroke& stroke, const Scene& scene,
                                        const ProjectClasses& classes) {
  if (stroke.tool != Tool::kFile) return scene.selector->select(stroke);
  const auto& known = scene.labels.classes;
  const auto its = std::ranges::find(known, stroke.edge_class, &FileClass::id);
  if (scene.labels.are_predicted || its == known.end() ||
      its->name != classes.table[stroke.edge_class].name) {
    throw Error(ErrorKind::kUsage,
                fmt::format("stroke: the file has no labels of class {}", stroke.edge_class));
  }
  return scene.selector->labelled(scene.labels.ids, stroke);
}

}  // namespace

Session::Session(SessionOptions options) : state_(std::make_unique<State>(std::move(options))) {
  if (state_->options.project.empty()) {
    state_->options.project = default_project(state_->options.input);
  }
  state_->worker = std::thread([state = state_.get()] { state->work(); });
}

Session::~Session() {
  {
    const Lock lock(state_->mutex);
    state_->orders.stopping = true;
    ++state_->orders.generation;
  }
  state_->changed.notify_all();
  state_->worker.join();
}

const SessionOptions& Session::options() const {
  return state_->options;
}

bool Session::is_accepted() const {
  const Lock lock(state_->mutex);
  if (state_->loading.failure) std::rethrow_exception(state_->loading.failure);
  return state_->loading.is_accepted;
}

void Session::wait_until_ready() const {
  Lock lock(state_->mutex);
  const Loading& loading = state_->loading;
  state_->changed.wait(lock, [&] { return loading.is_done || loading.failure; });
  if (loading.failure) std::rethrow_exception(loading.failure);
}

void Session::State::check_ready() const {
  if (loading.failure) std::rethrow_exception(loading.failure);
  if (!loading.is_done) throw Error(ErrorKind::kInsufficient, "the cloud is still being loaded");
}

void Session::State::check_cloud(std::size_t cloud) const {
  check_ready();
  if (cloud >= scenes.size()) throw NotFound(fmt::format("there is no cloud {}", cloud));
}

/// The cloud's part of per-point data.
std::span<const std::uint8_t> Session::State::part(std::span<const std::uint8_t> all,
                                                   std::size_t cloud) const {
  return all.subspan(firsts[cloud], scenes[cloud]->cloud.size());
}

/// Painted points of each cloud.
std::vector<std::size_t> Session::State::painted_of_each() const {
  std::vector<std::size_t> painted(scenes.size());
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const auto labels = part(painting->labels().classes(), k);
    const auto none = std::count(labels.begin(), labels.end(), kUnlabelled);
    painted[k] = labels.size() - static_cast<std::size_t>(none);
  }
  return painted;
}

/// Stops the worker and clears its orders.
void Session::State::interrupt() {
  ++orders.generation;
  orders.train_at.reset();
  orders.restore.reset();
  orders.asked_for = false;
  orders.find_lines.clear();
  orders.judge = false;
  for (std::size_t cloud = 0; cloud < reviews.size(); ++cloud) set_searching(cloud, false);
  runs.stop_awaiting();
  changed.notify_all();
}

/// Schedules training after a change of the training data.
void Session::State::schedule() {
  if (painting->settings().automatic || painting->labels().painted() == 0) {
    interrupt();
    orders.train_at = std::chrono::steady_clock::now() + kPause;
  } else if (!orders.asked_for) {
    orders.train_at.reset();
  }
}

/// An answer to a request that changes nothing.
Painted Session::State::standing() const {
  const Labels& labels = painting->labels();
  return {.counts = counts_of(labels.counts(), painting->classes()),
          .painted = painted_of_each(),
          .labels_version = labels_version,
          .undo = labels.undo_steps(),
          .redo = labels.redo_steps()};
}

/// After a step that concerned `points`.
Painted Session::State::answer_to(std::span<const std::uint32_t> points) {
  if (!points.empty()) {
    ++labels_version;
    schedule();
  }
  Painted painted = standing();
  painted.stroke = painted.undo;
  painted.changed = points.size();
  if (!points.empty()) {  // all of one cloud
    const auto next = std::upper_bound(firsts.begin(), firsts.end(), points.front());
    painted.cloud = static_cast<std::size_t>(next - firsts.begin()) - 1;
    painted.nodes = nodes_with(points, firsts[painted.cloud], scenes[painted.cloud]->layout);
  }
  if (!points.empty()) emit(painted);
  return painted;
}

Painted Session::paint(const Stroke& stroke) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_cloud(stroke.cloud);
  if (stroke.edge_class != kUnlabelled && !s.painting->classes().may_paint(stroke.edge_class)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("stroke: {} is no class that this project paints", stroke.edge_class));
  }
  if (const auto found = s.answers.find(stroke.id); found != s.answers.end()) return found->second;
  const auto prediction = s.runs.prediction(stroke.cloud);
  auto points =
      points_to_change(points_under(stroke, *s.scenes[stroke.cloud], s.painting->classes()), stroke,
                       s.part(s.painting->labels().classes(), stroke.cloud),
                       prediction ? std::span<const std::uint8_t>(prediction->result.classes)
                                  : std::span<const std::uint8_t>());
  for (std::uint32_t& point : points) point += static_cast<std::uint32_t>(s.firsts[stroke.cloud]);
  std::span<const std::uint32_t> changed;
  if (!points.empty()) {
    changed = s.painting->add(
        {.id = stroke.id, .edge_class = stroke.edge_class, .points = std::move(points)});
  }
  return s.answers[stroke.id] = s.answer_to(changed);
}

Painted Session::undo() {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  if (s.painting->labels().undo_steps() == 0) return s.answer_to({});
  return s.answer_to(s.painting->add({.kind = Record::Kind::kUndo}));
}

Painted Session::redo() {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  if (s.painting->labels().redo_steps() == 0) return s.answer_to({});
  return s.answer_to(s.painting->add({.kind = Record::Kind::kRedo}));
}

/// A page may choose a start that is offered, and no other file of the machine.
void Session::State::check_offered(const std::string& start_named) const {
  const auto& offered = options.starts;
  if (start_named == kRandomStart || start_named == painting->settings().start) return;
  if (std::find(offered.begin(), offered.end(), start_named) != offered.end()) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("start: {} or one of {}", kRandomStart, fmt::join(offered, ", ")));
}

Settings Session::change_settings(const SettingsChange& change) {
  State& s = *state_;
  const auto wanted_now = [&] {
    s.check_ready();
    return annotate::changed(s.painting->settings(), change);
  };
  Lock lock(s.mutex);
  const std::string name = wanted_now().start;
  s.check_offered(name);
  lock.unlock();  // others need not wait for the file
  std::optional<detect::EdgeModel> start;
  if (name != kRandomStart) start = s.options.load_model(name);
  lock.lock();
  Settings wanted = wanted_now();
  // A start that another request has chosen since was checked by that.
  if (start && wanted.start == name) {
    check_start(*start, name, s.painting->classes().table);
    if (!knows_smooth_edge(*start)) wanted.classes = 2;
  }
  if (wanted != s.painting->settings()) {
    s.painting->add({.kind = Record::Kind::kSettings, .settings = wanted});
    s.schedule();
  }
  return wanted;
}

ClassesChanged Session::change_classes(const ProjectClasses& wanted) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  const bool had_edges = s.painting->classes().has_edges();
  check_change(s.painting->classes(), wanted, s.painting->labels().counts(),
               s.painting->now().ever_painted);
  if (wanted != s.painting->classes()) {
    s.painting->add({.kind = Record::Kind::kClasses, .classes = wanted});
    if (had_edges != wanted.has_edges()) s.begin_anew();
  }
  ClassesChanged changed{.classes = wanted,
                         .counts = counts_of(s.painting->labels().counts(), wanted)};
  s.emit(changed);
  return changed;
}

/// After a change to classes that the start does not know, or back: nothing is painted yet.
void Session::State::begin_anew() {
  interrupt();
  Settings settings = painting->settings();
  settings.start =
      options.model.empty() || !begins_from(options.model) ? kRandomStart : options.model;
  fit_to_start(settings);
  if (settings != painting->settings()) {
    painting->add({.kind = Record::Kind::kSettings, .settings = settings});
  }
  runs.forget_start();
  schedule();
}

void Session::train_now() {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  check_can_learn(s.painting->labels().classes(), s.painting->settings(),
                  s.painting->classes().table);
  s.interrupt();
  s.orders.train_at = std::chrono::steady_clock::now();
  s.orders.asked_for = true;
}

void Session::cancel() {
  const Lock lock(state_->mutex);
  state_->interrupt();
}

void Session::restore(int run) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  if (!s.runs.find(run)) throw NotFound(fmt::format("there is no run {}", run));
  s.interrupt();
  s.orders.restore = run;
}

/// The files of the models that the project's runs started from, or the next one does.
std::vector<fs::path> Session::State::starts_in_use() const {
  std::vector<fs::path> places;
  if (!options.start_place || !painting) return places;
  std::set<std::string> names = {painting->settings().start};
  for (const Record& record : painting->records()) {
    if (record.kind == Record::Kind::kSettings) names.insert(record.settings.start);
    if (record.kind == Record::Kind::kRun) names.insert(record.run.settings.start);
  }
  names.erase(kRandomStart);
  for (const std::string& name : names) places.push_back(options.start_place(name));
  return places;
}

fs::path Session::target(Saved what, const std::string& name, std::size_t cloud) const {
  std::vector<fs::path> inputs = {state_->options.input};
  inputs.insert(inputs.end(), state_->options.further.begin(), state_->options.further.end());
  if (cloud >= inputs.size()) throw NotFound(fmt::format("there is no cloud {}", cloud));
  const Lock lock(state_->mutex);
  return saving_path(what, name, inputs, cloud, state_->options.project, state_->starts_in_use());
}

FileSaved Session::save(Saved what, const fs::path& path, Overwrite overwrite, std::size_t cloud,
                        io::DxfArcs arcs) const {
  Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_cloud(cloud);
  const auto scene = s.scenes[cloud];
  if (what == Saved::kProject) {
    const Project project{.inputs = s.inputs(), .records = s.painting->records()};
    lock.unlock();  // writing takes its time
    write_project(path, project, overwrite);
    return {path.string(), fs::file_size(path)};
  }
  if (what == Saved::kLines) {
    const LineReview review = s.reviews[cloud];
    lock.unlock();
    write_lines(path, review, scene->cloud, overwrite, arcs);
    return {path.string(), fs::file_size(path)};
  }
  const auto prediction = s.runs.settled_prediction(cloud);
  const std::size_t left_out =
      s.is_out_of_date() ? s.painting->strokes_since(s.runs.shown()->record.records) : 0;
  const auto its = s.part(s.painting->labels().classes(), cloud);
  const ProjectClasses classes = s.painting->classes();
  const std::vector<std::uint8_t> labels(its.begin(), its.end());
  lock.unlock();
  if (what == Saved::kModel) {
    if (!prediction)
      throw Error(ErrorKind::kInsufficient, "there is no model yet: paint and train");
    detect::save_model(path, with_names(prediction->model, classes.table), overwrite);
  } else {
    check_writable(path, overwrite);
    formats::write_cloud(path, saved_cloud(*scene, labels, classes.table, prediction.get()),
                         {.overwrite = overwrite});
  }
  return {path.string(), fs::file_size(path), left_out};
}

}  // namespace pcednet::annotate
