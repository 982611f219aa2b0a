#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/train.h"
#include "workbench/study/clouds.h"

namespace pcednet::study {

/// A network that the study trains, once for every seed.
struct NetworkMethod {
  detect::TrainOptions options = {};  ///< the seed is set by the runner
  int one_in = 1;                     ///< 5: a fifth of the training points, chosen by hash
  /// Largest scale over the diagonal when it classifies; empty: as in training.
  std::optional<double> s_max_fraction = {};
};

/// An existing network.
struct ModelMethod {
  std::filesystem::path file;
  gls::Engine engine = gls::Engine::kFast;
};

/// Predictions of another program: a file of classes per cloud, with the cloud's stem, in `folder`,
/// where "{set}" is replaced by the name of the set.
struct ExternalMethod {
  std::string folder;
};

/// A method without training.
struct ClassicMethod {
  std::string settings;  ///< determines, with the cloud, the result
  std::function<std::vector<std::uint8_t>(const PointCloud& cloud, const std::string& set,
                                          const Progress*)>
      classes;
};

using Method = std::variant<NetworkMethod, ModelMethod, ExternalMethod, ClassicMethod>;

/// The treatment of the test clouds before they are classified.
struct Treatment {
  double keep = 1.0;              ///< share of the points
  double noise = 0.0;             ///< standard deviation over the diagonal
  bool along_normal = false;      ///< noise along the normal, not on every axis
  bool estimate_normals = false;  ///< even if they have some; after the noise

  bool operator==(const Treatment&) const = default;
};

/// The work whose cost a variant reports.
enum class Phase { kAll, kDescribeTraining, kTrain, kDescribe, kClassify };

/// One row of an experiment's table: a method under some condition.
struct Variant {
  std::string id;     ///< of a sweep: the name of the line, '-', the number
  std::string title;  ///< for people
  Method method;
  std::optional<double> x = {};  ///< the swept value
  Treatment treatment = {};
  std::string note = {};
  std::shared_ptr<const CloudSet> training = {};  ///< empty: the study's
  std::shared_ptr<const CloudSet> test = {};      ///< empty: every set of the study
  Phase phase = Phase::kAll;
};

struct Experiment {
  std::string name, title, question;
  std::optional<std::string> x_label = {};  ///< of a sweep
  std::vector<Variant> variants = {};
  bool both_positives = false;  ///< score the sharp class alone and with the smooth one
  bool curves = false;          ///< keep the learning curves
  bool timed = false;  ///< seconds and joules are the result: another machine's do not count
};

struct NamedMethod {
  std::string id, title;
  ClassicMethod method;
};

/// The user's options.
struct PlanOptions {
  detect::TrainOptions training = {};  ///< where an experiment does not vary it
  bool quick = false;                  ///< fewer epochs, samples, sizes: for a first look
  std::vector<std::pair<std::string, std::filesystem::path>> models = {};  ///< id, file
  std::vector<std::pair<std::string, std::string>> predictions = {};       ///< id, folder
  std::vector<NamedMethod> classic = {};
};

/// The experiments, in the order of the paper: name and a line on what each shows.
struct ExperimentEntry {
  std::string_view name, summary;
  Experiment (*make)(const PlanOptions&);
};
const std::vector<ExperimentEntry>& experiments();

/// Throws Error(kUsage), listing the names, for an unknown name.
Experiment make_experiment(std::string_view name, const PlanOptions& options);

}  // namespace pcednet::study
