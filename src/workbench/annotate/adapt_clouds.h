#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "pcednet/detect/train.h"

namespace pcednet::annotate {

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
