#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pcednet/detect/train.h"
#include "workbench/annotate/described.h"
#include "workbench/annotate/project.h"

namespace pcednet::annotate {

/// Rounds of training: fewer than for a data set, as the painted points are few and the user waits.
inline constexpr int kEpochs = 20;

/// How many classes training on `labels` has under `settings`: two also where three are wished for
/// but no point is painted smooth-edge. Throws Error(kInsufficient), saying what to paint, unless
/// non-edge and sharp-edge are there.
int classes_to_learn(std::span<const std::uint8_t> labels, const Settings& settings);

/// The descriptor that a run wants: that of the model it starts from.
gls::ScaleSpaceOptions descriptor_of(const detect::EdgeModel* start);

/// `model` with the outputs of `classes` classes alone: 2 leaves out smooth-edge of three. Throws
/// Error(kModelMismatch) where that is impossible.
detect::EdgeModel with_classes(const detect::EdgeModel& model, int classes);

/// Trains on the painted points. `start` is null (random weights) or a model to start from, whose
/// descriptor `described` must have. Depends on the arguments alone, not on the number of threads.
detect::TrainedModel learn(const std::string& name, const Described& described,
                           std::span<const std::uint8_t> labels, const Settings& settings,
                           const detect::EdgeModel* start,
                           const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                           const Progress* progress = nullptr);

/// The model of a project's chosen run, or if it has none of its last labels, as the annotator
/// saves it. `load_start` gives the model of a name. Throws Error(kInsufficient) if `input` is not
/// the project's, and as labels_of().
detect::TrainedModel learn_project(
    const Project& project, const std::filesystem::path& input,
    const std::function<detect::EdgeModel(const std::string& name)>& load_start,
    const std::function<void(const nn::EpochReport&)>& on_epoch = {},
    const Progress* progress = nullptr);

}  // namespace pcednet::annotate
