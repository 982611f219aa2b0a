#pragma once

#include <functional>
#include <string>

#include "pcednet/detect/train.h"
#include "workbench/annotate/adapt.h"
#include "workbench/annotate/outputs.h"
#include "workbench/annotate/project.h"

namespace pcednet::annotate {

/// How many edge classes training on `labels` has under `settings`: two also where three are wished
/// for but no point is painted smooth-edge. Throws Error(kInsufficient), saying what to paint,
/// unless non-edge and sharp-edge are there.
int classes_to_learn(std::span<const std::uint8_t> labels, const Settings& settings);

/// Throws Error(kInsufficient), saying what to paint, unless `labels` can be learnt from: from
/// random weights as classes_to_learn(), with own classes points of any two; with a model to start
/// from any painted point.
void check_can_learn(std::span<const std::uint8_t> labels, const Settings& settings,
                     const ClassTable& table);

/// The descriptor that a run wants: that of the model it starts from.
gls::ScaleSpaceOptions descriptor_of(const detect::EdgeModel* start);

/// Epochs that a training reports.
int epochs_of(const Start* start);

/// Trains on the painted points; labels are as adapt() takes them. `start` is null (random weights)
/// or what to start from, with_classes() of the settings, which can_start(). Depends on the
/// arguments alone, not on the number of threads. Throws as check_can_learn() without a start.
Adapted learn(const std::string& name, const Subject& subject, std::span<const std::uint8_t> labels,
              const Settings& settings, const Start* start,
              const std::function<void(const nn::EpochReport&)>& on_epoch = {},
              const Progress* progress = nullptr);

/// The model of a project's chosen run, or if it has none of its last labels, as the annotator
/// saves it; `inputs` are the project's. `load_start` gives the model of a name. Throws
/// Error(kInsufficient) if an input is not the project's, and as labels_of().
detect::TrainedModel learn_project(
    const Project& project, std::span<const std::filesystem::path> inputs,
    const std::function<detect::EdgeModel(const std::string& name)>& load_start,
    const std::function<void(const nn::EpochReport&)>& on_epoch = {},
    const Progress* progress = nullptr);

}  // namespace pcednet::annotate
