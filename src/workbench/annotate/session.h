#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "workbench/annotate/messages.h"
#include "workbench/annotate/project/stroke.h"
#include "workbench/annotate/saving.h"

namespace pcednet::annotate {

struct SessionOptions {
  std::filesystem::path input = {};
  std::vector<std::filesystem::path> further = {};  ///< further inputs for the same training
  std::filesystem::path project = {};               ///< empty: see default_project()
  std::filesystem::path cache_folder = {};          ///< empty: descriptions are not kept
  std::string model = {};                           ///< start of a new project; empty: none
  bool is_model_wanted = false;            ///< an existing project starts from it too, from now on
  std::optional<ClassTable> classes = {};  ///< of a new project, or to add to an existing one
  std::vector<std::string> starts = {};    ///< models that the page may choose as starts, besides
                                           ///< the one that the project has
  bool overwrite = false;                  ///< saving replaces files without a request
  /// Loads the model behind `model`, one of `starts` or a start of the project, but never a name
  /// that only the page gave.
  std::function<detect::EdgeModel(const std::string& name)> load_model = {};
  /// The place of that model's file, which is then never overwritten; empty: none is protected.
  std::function<std::filesystem::path(const std::string& name)> start_place = {};
  /// Called with every event, from any thread; must not call the session.
  std::function<void(const Event& event)> emit = {};
};

/// kErrors compares the prediction with the labels of the file, see error_of().
enum class Shown {
  kLabels,
  kPrediction,
  kConfidence,
  kPSharp,
  kFeature,
  kFileLabels,
  kLasClasses,
  kErrors
};

/// A running annotation of one or several clouds: loading, painting, training, saving. Loading and
/// training run on a separate thread; every function may be called from any thread. The journal is
/// beside the project: a stroke that was answered survives the end of the program. Clouds are
/// numbered from 0; one training covers all.
///
/// Errors: kUsage for an invalid request, NotFound for something that does not exist, kInsufficient
/// for something not possible now.
class Session {
 public:
  explicit Session(SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Whether the cloud and the project have proved valid: only computing descriptors takes time
  /// from now on. Throws the error that prevents painting for good.
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

  /// A stroke with the id of an earlier one gets the earlier answer.
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

  LinesView lines(std::size_t cloud = 0) const;
  /// Finds the lines in the present prediction of a cloud, on the session's thread; with boundaries
  /// also those where the surface ends.
  void find_lines(std::size_t cloud = 0, bool boundaries = false);
  /// Throws as annotate::decide() and keep_decisions() do, and decides nothing then.
  void decide(const LinesDecided& wanted);

  /// The place of rank `after` + 1.
  UncertainPlace uncertain(std::size_t after, std::size_t cloud = 0) const;
  PointView pick(const Vec3& local_origin, const Vec3& direction, double radius,
                 std::size_t cloud = 0) const;

  /// The path of `what`: see saving_path(); the starts are those that the project ever had.
  std::filesystem::path target(Saved what, const std::string& name, std::size_t cloud = 0) const;

  /// Writes `what` to `path`; of several clouds, the one of `cloud`. A model is that of the shown
  /// run, which the answer compares with the strokes. `arcs` is for lines in DXF.
  FileSaved save(Saved what, const std::filesystem::path& path, Overwrite overwrite,
                 std::size_t cloud = 0, io::DxfArcs arcs = io::DxfArcs::kAll) const;

  const SessionOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pcednet::annotate
