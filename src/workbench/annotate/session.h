#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "workbench/annotate/messages.h"
#include "workbench/annotate/saving.h"
#include "workbench/annotate/stroke.h"

namespace pcednet::annotate {

struct SessionOptions {
  std::filesystem::path input = {};
  std::vector<std::filesystem::path> further = {};  ///< inputs that are trained on together with it
  std::filesystem::path project = {};               ///< empty: see default_project()
  std::filesystem::path cache_folder = {};          ///< empty: descriptions are not kept
  std::string model = {};                           ///< that a new project starts from; empty: none
  bool is_model_wanted = false;            ///< an older project starts from it from now on, too
  std::optional<ClassTable> classes = {};  ///< of a new project, or to add to an older one
  std::vector<std::string> starts = {};    ///< models that the page may start from, for its list
  bool overwrite = false;                  ///< saving replaces files without being asked to
  /// The model behind `model` or a name of Settings::start, which the page gives: throws, and opens
  /// no file, for any that it may not have.
  std::function<detect::EdgeModel(const std::string& name)> load_model = {};
  /// Gets every event, from any thread; must not call the session.
  std::function<void(const Event& event)> emit = {};
};

enum class Shown { kLabels, kPrediction, kConfidence, kPSharp, kFeature };

/// An annotation of one cloud or of several while it lasts: loading, painting, training, saving.
/// Loading and training run on a thread of its own; every function may be called from any thread.
/// The journal is beside the project: what a stroke's answer reports survives the end of the
/// program. Clouds are numbered from 0; all are trained on together.
///
/// Errors: kUsage for a request that makes no sense, NotFound for what is not there, kInsufficient
/// for what is not possible now.
class Session {
 public:
  explicit Session(SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Whether the cloud and the project were found to be sound: all that takes time from now on is
  /// computing descriptors. Throws what prevents the cloud from ever being painted.
  bool is_accepted() const;

  /// Blocks until the cloud can be painted; throws like is_accepted().
  void wait_until_ready() const;

  Summary summary(std::size_t cloud = 0) const;
  std::vector<std::byte> node_points(std::size_t node, std::size_t cloud = 0) const;

  struct Values {
    std::vector<std::uint8_t> bytes = {};
    int version = 0;
  };
  /// A byte per point of the nodes; `feature` and `scale` choose a Shown::kFeature.
  Values values(Shown what, const std::vector<std::size_t>& nodes, int feature, int scale,
                std::size_t cloud = 0) const;

  /// A stroke of an id that was painted before gets the answer that it got then.
  Painted paint(const Stroke& stroke);
  Painted undo();
  Painted redo();
  Settings change_settings(const SettingsChange& change);
  /// See check_change().
  ClassesChanged change_classes(const ProjectClasses& wanted);
  void train_now();
  void cancel();
  std::vector<RunView> runs() const;
  void restore(int run);

  LinesView lines() const;
  /// Finds the lines in the present prediction of a cloud, on the session's thread.
  void find_lines(std::size_t cloud = 0);
  /// Throws what annotate::decide() throws.
  void decide(const LinesDecided& wanted);

  /// The place after so many others.
  UncertainPlace uncertain(std::size_t after, std::size_t cloud = 0) const;
  PointView pick(const Vec3& local_origin, const Vec3& direction, double radius,
                 std::size_t cloud = 0) const;

  /// Where `what` goes: see saving_path().
  std::filesystem::path target(Saved what, const std::string& name, std::size_t cloud = 0) const;

  /// Writes `what` to `path` and returns the bytes written; of the clouds the one asked for.
  std::uintmax_t save(Saved what, const std::filesystem::path& path, Overwrite overwrite,
                      std::size_t cloud = 0) const;

  /// The cloud that the lines found last are of.
  std::size_t cloud_of_lines() const;

  const SessionOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pcednet::annotate
