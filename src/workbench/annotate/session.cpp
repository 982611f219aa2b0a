#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/io/write_cloud.h"
#include "workbench/annotate/learn.h"
#include "workbench/annotate/not_found.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Lock = std::unique_lock<std::mutex>;

namespace {

/// Whether `name` is that of a file, not of a folder or of a hidden file, to every function that
/// takes it: one ends it at a NUL byte, another at a slash. JSON has seen to it that it is UTF-8.
bool is_plain(const std::string& name) {
  const auto is_odd = [](unsigned char c) { return c < ' ' || c == 127 || c == '/' || c == '\\'; };
  return !name.empty() && name.size() <= 200 && name[0] != '.' &&
         std::none_of(name.begin(), name.end(), is_odd);
}

bool fits(Saved what, const std::string& extension) {
  if (what == Saved::kModel) return extension == ".safetensors";
  if (what == Saved::kProject) return extension == ".json";
  return extension == ".ply" || extension == ".pcd" || extension == ".obj" || extension == ".xyz" ||
         extension == ".csv";
}

}  // namespace

fs::path default_project(const fs::path& input) {
  return input.parent_path() / (input.stem().string() + "_annotation.json");
}

fs::path journal_of(fs::path project) {
  return project += ".journal";
}

Session::Session(SessionOptions options) : state_(std::make_unique<State>(std::move(options))) {
  if (state_->options.project.empty()) {
    state_->options.project = default_project(state_->options.input);
  }
  state_->worker = std::thread([state = state_.get()] { state->work(); });
}

Session::~Session() {
  {
    const Lock lock(state_->mutex);
    state_->stopping = true;
    ++state_->generation;
  }
  state_->changed.notify_all();
  state_->worker.join();
}

const SessionOptions& Session::options() const {
  return state_->options;
}

bool Session::is_ready() const {
  const Lock lock(state_->mutex);
  if (state_->failure) std::rethrow_exception(state_->failure);
  return state_->ready;
}

void Session::wait_until_ready() const {
  Lock lock(state_->mutex);
  state_->changed.wait(lock, [&] { return state_->ready || state_->failure; });
  if (state_->failure) std::rethrow_exception(state_->failure);
}

void Session::State::check_ready() const {
  if (failure) std::rethrow_exception(failure);
  if (!ready) throw Error(ErrorKind::kInsufficient, "the cloud is still being loaded");
}

const Prediction* Session::State::prediction() const {
  return current_run < 0 ? nullptr : runs[static_cast<std::size_t>(current_run)].prediction.get();
}

/// Writes the record before it counts: what the user is told has happened is in the journal.
void Session::State::keep(Record record) {
  journal->append(record);
  records.push_back(std::move(record));
}

/// Ends what the worker does and forgets what it was asked to do.
void Session::State::interrupt() {
  ++generation;
  due.reset();
  restore.reset();
  asked_for = false;
  if (!prediction()) current_run = -1;  // it was being made again
  changed.notify_all();
}

/// After a change of what is to be learnt: training waits half a second for the next stroke.
void Session::State::schedule() {
  if (settings.automatic) {
    interrupt();
    due = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
  } else if (!asked_for) {
    due.reset();
  }
}

/// That of the current run; null if there is none.
std::shared_ptr<const Prediction> Session::State::settled_prediction() const {
  if (current_run < 0) return {};
  const Run& run = runs[static_cast<std::size_t>(current_run)];
  if (!run.prediction) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("run {} is being trained again: wait for it", run.record.number));
  }
  return run.prediction;
}

Json Session::State::answer(std::size_t stroke, std::size_t points, Json nodes) const {
  return {{"stroke", stroke},
          {"changed", points},
          {"counts", labels->counts()},
          {"labels_version", labels_version},
          {"nodes", std::move(nodes)},
          {"undo", labels->undo_steps()},
          {"redo", labels->redo_steps()}};
}

std::string Session::State::painted(std::span<const std::uint32_t> points) {
  std::set<std::uint32_t> nodes;
  std::uint32_t last = kNoNode;
  for (const std::uint32_t point : points) {
    const std::uint32_t node = scene->layout.node_of[point];
    if (node != last && node != kNoNode) nodes.insert(last = node);
  }
  if (!points.empty()) {
    ++labels_version;
    schedule();
  }
  const Json done = answer(labels->undo_steps(), points.size(), nodes);
  if (!points.empty()) emit("labels", done);
  return done.dump();
}

std::string Session::paint(const Stroke& stroke) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  if (const auto found = s.answers.find(stroke.id); found != s.answers.end()) return found->second;
  const Prediction* prediction = s.prediction();
  auto points =
      points_to_change(s.scene->selector->select(stroke), stroke, s.labels->classes(),
                       prediction ? std::span<const std::uint8_t>(prediction->result.classes)
                                  : std::span<const std::uint8_t>());
  if (!points.empty()) {
    s.keep({.id = stroke.id, .edge_class = stroke.edge_class, .points = points});
    s.labels->paint(stroke.edge_class, points);
  }
  return s.answers[stroke.id] = s.painted(points);
}

std::string Session::undo() {
  const Lock lock(state_->mutex);
  state_->check_ready();
  if (state_->labels->undo_steps() > 0) state_->keep({.kind = Record::Kind::kUndo});
  return state_->painted(state_->labels->undo());
}

std::string Session::redo() {
  const Lock lock(state_->mutex);
  state_->check_ready();
  if (state_->labels->redo_steps() > 0) state_->keep({.kind = Record::Kind::kRedo});
  return state_->painted(state_->labels->redo());
}

std::string Session::change_settings(std::string_view json) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  const Settings wanted = parse_settings(json, s.settings);
  if (wanted.start != "random") s.options.load_model(wanted.start);
  if (wanted != s.settings) {
    s.keep({.kind = Record::Kind::kSettings, .settings = wanted});
    s.settings = wanted;
    s.schedule();
  }
  return to_json(wanted);
}

void Session::train_now() {
  const Lock lock(state_->mutex);
  state_->check_ready();
  classes_to_learn(state_->labels->classes(), state_->settings);
  state_->interrupt();
  state_->due = std::chrono::steady_clock::now();
  state_->asked_for = true;
}

void Session::cancel() {
  const Lock lock(state_->mutex);
  state_->interrupt();
}

void Session::restore(int run) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_ready();
  if (s.find_run(run) == s.runs.end()) {
    throw NotFound(fmt::format("there is no run {}", run));
  }
  s.interrupt();
  s.restore = run;
}

fs::path Session::target(Saved what, const std::string& name) const {
  const fs::path& input = state_->options.input;
  const fs::path& project = state_->options.project;
  if (!name.empty() && !(is_plain(name) && fits(what, fs::path(name).extension().string()))) {
    throw Error(ErrorKind::kUsage,
                "name: a file name without folder, ending in .ply, .pcd, .obj, .xyz or .csv for a "
                "cloud, .safetensors for a model, .json for a project");
  }
  fs::path path = input.parent_path() / name;
  if (name.empty()) {
    if (what == Saved::kProject) return project;
    path /= input.stem().string() + (what == Saved::kCloud ? "_annotated.ply" : ".safetensors");
  }
  for (const fs::path& kept : {input, journal_of(project), project}) {
    std::error_code error;
    if ((what != Saved::kProject || kept != project) && fs::equivalent(path, kept, error)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("name: {} itself is never overwritten", kept.filename().string()));
    }
  }
  return path;
}

std::uintmax_t Session::save(Saved what, const fs::path& path, Overwrite overwrite) const {
  Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_ready();
  const auto scene = s.scene;
  const auto prediction = what == Saved::kProject ? nullptr : s.settled_prediction();
  const auto labels = s.labels->classes();
  const Project project{.input = scene->input,
                        .records = what == Saved::kProject ? s.records : std::vector<Record>()};
  lock.unlock();  // writing takes its time
  if (what == Saved::kProject) {
    write_project(path, project, overwrite);
  } else if (what == Saved::kModel) {
    if (!prediction)
      throw Error(ErrorKind::kInsufficient, "there is no model yet: paint and train");
    detect::save_model(path, prediction->model, overwrite);
  } else {
    check_writable(path, overwrite);
    PointCloud cloud = scene->cloud;
    if (prediction) {
      detect::add_result(cloud, scene->prepared, prediction->result, prediction->model);
    } else {
      if (cloud.has_labels())
        set_attribute(cloud, make_attribute("scalar_input_label", cloud.labels));
      cloud.labels = labels;
    }
    set_attribute(cloud, make_attribute("scalar_painted_label", labels));
    io::write_cloud(path, cloud, {.overwrite = overwrite});
  }
  return fs::file_size(path);
}

}  // namespace pcednet::annotate
