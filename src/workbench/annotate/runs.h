#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "workbench/annotate/messages.h"

namespace pcednet::annotate {

/// What is found in each cloud.
using Predictions = std::vector<std::shared_ptr<const Prediction>>;

/// A training and its outcome.
struct Run {
  RunRecord record = {};
  Predictions predictions = {};                 ///< one per cloud; none unless it is shown
  std::optional<detect::EdgeModel> model = {};  ///< none as long as an earlier start made it
  std::optional<HeldOut> held_out = {};         ///< none as long as it is not known
};

/// The runs of a session by ascending number. The one that is shown is the only one with a
/// prediction: models give those of the others again. A run without one is shown only while it is
/// being trained again.
class Runs {
 public:
  /// Lists a run of an earlier start, whose number is above all others.
  void remember(const RunRecord& record);

  /// The run of that number, or null.
  const Run* find(int number) const;

  /// The run that is shown, or null.
  const Run* shown() const { return shown_ ? find(*shown_) : nullptr; }

  /// What `shown` predicts for a cloud, or null.
  std::shared_ptr<const Prediction> prediction(std::size_t cloud) const;

  /// The same, but throws Error(kInsufficient) if that run is being trained again.
  std::shared_ptr<const Prediction> settled_prediction(std::size_t cloud) const;

  /// How many predictions there were.
  int version() const { return version_; }

  /// Shows a run, which must have a prediction, in the place of the one of its number.
  void show(Run run);

  /// Says how the run of that number did on strokes held out, if there is one.
  void judge(int number, const HeldOut& held_out);

  /// Shows a run that was remembered and is being trained again.
  void await(int number) { shown_ = number; }

  /// Forgets what a start found.
  void forget_start();

  /// Shows no run rather than one that is not being trained again after all.
  void stop_awaiting();

  std::vector<RunView> views() const;
  std::optional<RunView> shown_view() const;

 private:
  std::vector<Run> runs_;
  std::optional<int> shown_;
  int version_ = 0;
};

}  // namespace pcednet::annotate
