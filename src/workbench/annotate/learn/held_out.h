#pragma once

#include <optional>

#include "workbench/annotate/learn/learn.h"
#include "workbench/annotate/project/labels.h"

namespace pcednet::annotate {

/// The accuracy of trainings on held-out strokes.
struct HeldOut {
  std::size_t strokes = 0;  ///< that painted the present labels
  /// The macro average of the accuracy over the painted classes; none: too few strokes to estimate
  /// it.
  std::optional<double> accuracy = {};
  std::optional<double> start = {};  ///< that of the start's own predictions, if there is a start
};

/// Cross-validates by strokes: trains several times as learn() does, each time without some of the
/// strokes, and tests on these. Points beside painted ones are no independent test; whole strokes
/// are. Every painted class needs two strokes, and there must be two such classes. Throws
/// Error(kCancelled).
HeldOut hold_out(const Subject& subject, const Labels& labels, const Settings& settings,
                 const Start* start, const Progress* progress = nullptr);

}  // namespace pcednet::annotate
