#pragma once

#include <span>
#include <string>

#include "pcednet/detect/model.h"

namespace pcednet::annotate {

/// Whether training under `table` may start from `model`: its classes are the first of the table.
bool can_start(const detect::EdgeModel& model, const ClassTable& table);

/// Throws Error(kUsage), with the reason, unless it can; `name` is the model's.
void check_start(const detect::EdgeModel& model, const std::string& name, const ClassTable& table);

/// `model` under `table`, with an output for each class in `labels` that is new to it; new outputs
/// are never chosen before training.
detect::EdgeModel with_outputs(detect::EdgeModel model, const ClassTable& table,
                               std::span<const std::uint8_t> labels);

/// A model that never predicts smooth-edge if `classes` is 2; the odds of the other classes stay.
/// Otherwise, and without edge classes, `model` unchanged.
detect::EdgeModel with_classes(detect::EdgeModel model, int classes);

/// Whether smooth-edge is an answer of the model, or no class of its table.
bool knows_smooth_edge(const detect::EdgeModel& model);

/// `model` with the names and colours that `table` has now.
detect::EdgeModel with_names(detect::EdgeModel model, const ClassTable& table);

}  // namespace pcednet::annotate
