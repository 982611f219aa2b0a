#pragma once

#include <optional>

#include "workbench/annotate/labels.h"
#include "workbench/annotate/learn.h"

namespace pcednet::annotate {

/// How well trainings answer for strokes that they did not see.
struct HeldOut {
  std::size_t strokes = 0;  ///< that painted what is painted now
  /// The share of right points, the mean over the painted classes; none: too few strokes to tell.
  std::optional<double> accuracy = {};
  std::optional<double> start = {};  ///< that of the start's own answer, if there is a start
};

/// Trains as learn() does, several times, each time without some of the strokes, and asks about
/// these: points beside painted ones say nothing about the others, whole strokes do. Every class
/// that is painted needs two strokes, and there must be two such classes. Throws Error(kCancelled).
HeldOut hold_out(const Subject& subject, const Labels& labels, const Settings& settings,
                 const Start* start, const Progress* progress = nullptr);

}  // namespace pcednet::annotate
