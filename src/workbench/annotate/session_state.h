#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "workbench/annotate/project/painting.h"
#include "workbench/annotate/runs.h"
#include "workbench/annotate/session.h"

namespace pcednet::annotate {

/// The progress of the worker.
struct Loading {
  bool is_accepted = false;  ///< the cloud and the project are valid and not open elsewhere
  bool is_done = false;
  std::exception_ptr failure = {};  ///< if it failed for good
  std::string stage = "read";       ///< also of training
};

/// The orders for the worker. Work begun under an older generation is void.
struct Orders {
  std::optional<std::chrono::steady_clock::time_point> train_at = {};
  bool asked_for = false;  ///< by the user: failure is an error
  /// In these clouds, when nothing else is to be done, and whether with boundaries.
  std::map<std::size_t, bool> find_lines = {};
  bool judge = false;               ///< the shown run, after everything else
  std::optional<int> restore = {};  ///< a run
  std::uint64_t generation = 0;
  bool stopping = false;
};

/// The points that rank_uncertain() found for a version of a cloud's prediction.
struct UncertainRanking {
  int version = -1;
  std::size_t cloud = 0;
  std::vector<std::uint32_t> points = {};
};

struct Session::State {
  explicit State(SessionOptions given) : options(std::move(given)) {}

  SessionOptions options;
  std::thread worker = {};
  mutable std::condition_variable changed = {};
  mutable std::mutex mutex = {};  ///< of all that follows

  Loading loading = {};
  Orders orders = {};

  // Set once loading is done.
  std::vector<std::shared_ptr<const Scene>> scenes = {};  ///< one per cloud
  std::vector<std::size_t> firsts = {};  ///< and the number of its first point in all
  std::vector<std::shared_ptr<const Described>> described = {};  ///< as the last model wanted it
  std::optional<Painting> painting = {};

  std::map<std::string, Painted> answers = {};  ///< to strokes, by their ids
  int labels_version = 0;

  /// The last start; used only by the worker's thread.
  std::shared_ptr<const Start> start = {};
  std::string start_name = {};
  int start_classes = 0;
  std::size_t start_clouds = 0;

  Runs runs = {};
  mutable UncertainRanking uncertain = {};
  std::vector<LineReview> reviews = {};  ///< one per cloud

  void emit(const Event& event) const;
  Progress progress(std::uint64_t of_generation);
  Progress cancellation(std::uint64_t of_generation) const;  ///< the same without a report
  bool is_void(std::uint64_t of_generation) const;

  // On the worker's thread, without the mutex.
  void work();
  void load();
  void open_project();
  void train_once(std::uint64_t mine);
  void restore_once(int number, std::uint64_t mine);
  void find_lines_once(std::size_t cloud, bool boundaries, std::uint64_t mine);
  void judge_once(std::uint64_t mine);
  bool train(Run& run, std::span<const std::uint8_t> painted_classes, std::uint64_t mine);
  bool train_again(Run& run, std::uint64_t mine);
  void classify(Run& run, std::uint64_t mine);
  void show_start(const Settings& settings, std::uint64_t mine);
  std::shared_ptr<const Start> start_of(const Settings& settings, std::size_t clouds,
                                        std::uint64_t mine);
  Subject subject_of(std::span<const std::shared_ptr<const Described>> rows) const;
  Predictions predictions_of(const detect::EdgeModel& model, const detect::Classification& found,
                             std::uint64_t mine);
  std::span<const std::uint8_t> part(std::span<const std::uint8_t> all, std::size_t cloud) const;
  ClassTable table() const;
  Inputs inputs() const;
  std::filesystem::path input_of(std::size_t cloud) const;
  gls::ScaleSpaceOptions first_descriptor() const;
  std::vector<std::shared_ptr<const Described>> descriptions(
      const gls::ScaleSpaceOptions& descriptor, std::size_t clouds, std::uint64_t of_generation);

  // With the mutex.
  bool is_training_due() const;
  void wait_for_orders(std::unique_lock<std::mutex>& lock);
  std::function<void()> next_work();
  void check_ready() const;
  void check_cloud(std::size_t cloud) const;
  void check_offered(const std::string& start_named) const;
  std::vector<std::filesystem::path> starts_in_use() const;
  void show(Run run);
  bool is_out_of_date() const;
  void set_searching(std::size_t cloud, bool on);
  Painted answer_to(std::span<const std::uint32_t> points);
  Painted standing() const;
  std::vector<std::size_t> painted_of_each() const;
  void interrupt();
  void schedule();
  void begin_anew();
  void choose_classes();
  void choose_start(bool is_new);
  void offer(const std::string& start_named);
  bool begins_from(const std::string& model) const;
  void fit_to_start(Settings& settings) const;
  void remember_runs();
  std::vector<std::uint32_t> points_of(const std::vector<std::size_t>& nodes,
                                       std::size_t cloud) const;
};

}  // namespace pcednet::annotate
