#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "workbench/annotate/journal.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {

/// A training and its outcome.
struct Run {
  RunRecord record = {};
  std::shared_ptr<const Prediction> prediction = {};  ///< null once others have followed
  std::optional<detect::EdgeModel> model = {};        ///< none as long as an earlier start made it
};

/// The number, or null.
template <typename Number>
nlohmann::json optional_number(const std::optional<Number>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

struct Session::State {
  explicit State(SessionOptions given) : options(std::move(given)) {}

  SessionOptions options;
  mutable std::mutex mutex = {};  ///< of all that follows
  mutable std::condition_variable changed = {};
  std::thread worker = {};

  // Loading.
  bool ready = false;
  std::exception_ptr failure = {};
  std::string stage = "read";
  std::shared_ptr<const Scene> scene = {};
  std::shared_ptr<const Described> described = {};

  // Painting.
  std::unique_ptr<Journal> journal = {};
  std::vector<Record> records = {};
  std::unique_ptr<Labels> labels = {};
  Settings settings = {};
  std::map<std::string, std::string> answers = {};  ///< to strokes, by their names
  int labels_version = 0;

  // Training.
  std::vector<Run> runs = {};  ///< by ascending number
  int current_run = -1;        ///< in `runs`; without a prediction while it is being made again
  int recorded_run = 0;        ///< the number of the one that the records say is current
  int next_run = 1;
  int prediction_version = 0;
  std::optional<std::chrono::steady_clock::time_point> due = {};
  bool asked_for = false;  ///< by the user: tell them if it cannot be done
  std::optional<int> restore = {};
  std::uint64_t generation = 0;  ///< a training of an older one is void
  bool stopping = false;

  mutable std::vector<std::uint32_t> uncertain = {};
  mutable int uncertain_version = -1;

  void emit(const std::string& name, const nlohmann::json& json) const;
  Progress progress(std::uint64_t of_generation);
  bool is_void(std::uint64_t of_generation) const;

  // On the worker's thread, without the mutex.
  void work();
  void load();
  void open_project();
  void remember_runs(const Replayed& end);
  void train_once(std::uint64_t mine);
  void restore_once(int number, std::uint64_t mine);
  bool train(Run& run, std::span<const std::uint8_t> painted_classes, std::uint64_t mine);
  bool train_again(Run& run, std::uint64_t mine);
  void classify(Run& run, std::uint64_t mine);
  void show_model(const std::string& name);
  std::shared_ptr<const Described> description(const gls::ScaleSpaceOptions& descriptor,
                                               std::uint64_t of_generation);

  // With the mutex.
  void check_ready() const;
  void publish(Run run);
  std::string painted(std::span<const std::uint32_t> points);
  nlohmann::json answer(std::size_t stroke, std::size_t points, nlohmann::json nodes) const;
  void keep(Record record);
  void interrupt();
  void schedule();
  std::shared_ptr<const Prediction> settled_prediction() const;
  nlohmann::json run_json(std::size_t run) const;
  std::vector<Run>::iterator find_run(int number);
  const Prediction* prediction() const;
};

}  // namespace pcednet::annotate
