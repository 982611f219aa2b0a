#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "pcednet/detect/train.h"
#include "pcednet/io/loaded_cloud.h"
#include "workbench/annotate/learn/adapt.h"
#include "workbench/annotate/learn/outputs.h"
#include "workbench/annotate/project/project.h"

namespace pcednet::annotate {

/// The number of edge classes of a training on `labels` under `settings`: two even if three are
/// requested but no point is painted smooth-edge. Throws Error(kInsufficient), saying what to
/// paint, unless there are points of non-edge and sharp-edge.
int classes_to_learn(std::span<const std::uint8_t> labels, const Settings& settings);

/// Throws Error(kInsufficient), saying what to paint, unless `labels` suffice: from random weights
/// see classes_to_learn(), or, with own classes, points of any two; with a model to start from, any
/// painted point.
void check_can_learn(std::span<const std::uint8_t> labels, const Settings& settings,
                     const ClassTable& table);

/// The descriptor of a run: that of the model it starts from.
gls::ScaleSpaceOptions descriptor_of(const detect::EdgeModel* start);

/// The number of epochs that a training reports, and those of them that are the context network's,
/// which trains last.
int epochs_of(const Start* start);
int context_epochs_of(const Start* start);

/// Trains on the painted points; labels as for adapt(). `start` is null (random weights) or the
/// model to start from, with_classes() of the settings, which can_start(). Depends only on the
/// arguments, not on the number of threads. Throws as check_can_learn() without a start.
Adapted learn(const std::string& name, const Subject& subject, std::span<const std::uint8_t> labels,
              const Settings& settings, const Start* start,
              const std::function<void(const nn::EpochReport&)>& on_epoch = {},
              const Progress* progress = nullptr);

/// Whether a training that should repeat `run` ended with another loss than it had, which records
/// of the first version do not tell.
bool is_another(const RunRecord& run, double loss);

/// What the user is told then.
std::string not_reproduced(int run);

/// An input of a project, ready to be learnt from.
struct ProjectCloud {
  std::filesystem::path file = {};
  io::LoadedCloud loaded = {};
  detect::PreparedCloud prepared = {};
  std::shared_ptr<const Described> described = {};
};

/// Where the files of a project are, and who hears of its clouds.
struct ProjectFiles {
  /// The file of an input by its number from 0, for those that the run had.
  std::function<std::filesystem::path(std::size_t)> input_of = {};
  std::function<detect::EdgeModel(const std::string& name)> load_start = {};
  std::function<void(const ProjectCloud&)> on_cloud = {};  ///< after each; may be empty
};

/// The model of a project's chosen run or, if it has none, of its last labels, as the annotator
/// saves it. The notes tell if it is not the model that the run had. Throws Error(kInsufficient) if
/// an input is not the project's, and as labels_of().
detect::TrainedModel learn_project(const Project& project, const ProjectFiles& files,
                                   const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                                   const Progress* progress = nullptr);

}  // namespace pcednet::annotate
