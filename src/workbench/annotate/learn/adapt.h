#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/train.h"
#include "pcednet/nn/train.h"
#include "workbench/annotate/learn/subject.h"

namespace pcednet::annotate {

/// A model to start from and its predictions for the subject.
struct Start {
  detect::EdgeModel model = {};
  detect::Classification answer = {};
  std::vector<detect::ContextPlaces> places = {};  ///< one per cloud, if there is a context network
};

/// `model`, and its predictions for clouds described as it requires. Throws Error(kCancelled) if
/// `progress` asks to cancel.
Start make_start(detect::EdgeModel model, const Subject& subject,
                 const Progress* progress = nullptr);

/// The label of a point that training must not use: it is not painted, and the start's prediction
/// for it is meaningless.
inline constexpr std::uint8_t kLeftOut = 254;

/// Epochs of each of the two networks; adapt() reports the sum.
inline constexpr int kAdaptEpochs = 15;

struct Adapted {
  detect::EdgeModel model = {};
  detect::Classification found = {};  ///< its predictions for the subject
  bool cancelled = false;             ///< the rest is then unusable
  double loss = 0;                    ///< of the last epoch
  double seconds_classify = 0;        ///< the classification's share of the time
};

/// Fine-tunes a model on the painted points without unlearning the rest (self-distillation): the
/// network trains on the painted points with their labels and on a sample of the others with the
/// start's own predictions as targets; then the context network trains on the predictions of the
/// new network. Predictions away from painted points therefore stay, except at points with the same
/// description as points painted otherwise.
///
/// `labels` has, per point, a paintable class of the subject's table, kUnlabelled or kLeftOut; the
/// start's classes are the first of the table, and the network gets outputs for classes new to it.
/// Depends only on the arguments, not on the number of threads or the numbering of the points.
Adapted adapt(const std::string& name, const Start& start, const Subject& subject,
              std::span<const std::uint8_t> labels, std::uint64_t seed,
              const std::function<void(const nn::EpochReport&)>& on_epoch = {},
              const Progress* progress = nullptr);

/// Throws Error(kUsage), naming both classes, unless `model` can_start() a training under `table`.
void check_classes_of_start(const detect::EdgeModel& model, const ClassTable& table);

/// Throws Error(kInsufficient), naming the cloud, if one has no labelled point.
void check_each_is_labelled(std::span<const detect::NamedLabels> clouds, const ClassTable& table);

/// Fine-tunes `model` on the labelled points of clouds, prepared for it, as adapt() does. Labels
/// index `table`; others count as unlabelled. Throws as check_classes_of_start().
detect::TrainedModel adapt_clouds(const std::string& name, const detect::EdgeModel& model,
                                  std::span<const detect::TrainingCloud> clouds,
                                  const ClassTable& table, std::uint64_t seed,
                                  const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                                  const Progress* progress = nullptr);

}  // namespace pcednet::annotate
