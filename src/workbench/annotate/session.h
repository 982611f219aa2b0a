#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "workbench/annotate/scene.h"
#include "workbench/annotate/stroke.h"

namespace pcednet::annotate {

struct SessionOptions {
  std::filesystem::path input = {};
  std::filesystem::path project = {};       ///< empty: see default_project()
  std::filesystem::path cache_folder = {};  ///< empty: descriptions are not kept
  std::string model = {};                   ///< to classify with at once; empty: none
  bool overwrite = false;                   ///< saving replaces files without being asked to
  /// The model behind `model` or a name of Settings::start, which the page gives: throws, and opens
  /// no file, for any that it may not have.
  std::function<detect::EdgeModel(const std::string& name)> load_model = {};
  /// Is told of every event with its JSON, from any thread; must not call the session.
  std::function<void(const std::string& name, const std::string& json)> emit = {};
};

/// `<stem>_annotation.json` beside the input.
std::filesystem::path default_project(const std::filesystem::path& input);

/// `<project>.journal`.
std::filesystem::path journal_of(std::filesystem::path project);

enum class Saved { kCloud, kModel, kProject };
enum class Shown { kLabels, kPrediction, kConfidence, kPSharp, kFeature };

/// An annotation of one cloud while it lasts: loading, painting, training, saving. Loading and
/// training run on a thread of its own; every function may be called from any thread. The journal
/// is beside the project: what a stroke's answer reports survives the end of the program.
///
/// Answers are JSON as docs/annotate.md describes. Errors: kUsage for a request that makes no
/// sense, NotFound for what is not there, kInsufficient for what is not possible now.
class Session {
 public:
  explicit Session(SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Whether the cloud can be painted yet; throws what prevents it from ever being.
  bool is_ready() const;

  /// Blocks until it is.
  void wait_until_ready() const;

  std::string summary(bool writer) const;
  std::vector<std::byte> node_points(std::size_t node) const;

  struct Values {
    std::vector<std::uint8_t> bytes = {};
    int version = 0;
  };
  /// A byte per point of the nodes; `feature` and `scale` choose a Shown::kFeature.
  Values values(Shown what, const std::vector<std::size_t>& nodes, int feature, int scale) const;

  std::string paint(const Stroke& stroke);
  std::string undo();
  std::string redo();
  std::string change_settings(std::string_view json);
  void train_now();
  void cancel();
  std::string runs() const;
  void restore(int run);

  std::string uncertain(std::size_t after) const;
  std::string pick(const Vec3& local_origin, const Vec3& direction, double radius) const;

  /// Where `what` goes: `name` or the usual one, beside the input. Throws Error(kUsage) unless
  /// `name` is a plain file name of `what` that is neither the input, its journal nor another's
  /// project.
  std::filesystem::path target(Saved what, const std::string& name) const;

  /// Writes `what` to `path` and returns the bytes written.
  std::uintmax_t save(Saved what, const std::filesystem::path& path, Overwrite overwrite) const;

  const SessionOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pcednet::annotate
