#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "workbench/annotate/messages.h"

namespace pcednet::annotate {

/// The predictions for each cloud.
using Predictions = std::vector<std::shared_ptr<const Prediction>>;

/// A training and its outcome.
struct Run {
  RunRecord record = {};
  Predictions predictions = {};                 ///< one per cloud; none unless it is shown
  std::optional<detect::EdgeModel> model = {};  ///< none for a run of an earlier start
  std::optional<HeldOut> held_out = {};         ///< none until known
};

/// The runs of a session by ascending number. Only the shown run has predictions: those of others
/// are recomputed from their models. A run without predictions is shown only while it is trained
/// again.
class Runs {
 public:
  /// Lists a run of an earlier start, whose number is above all others.
  void remember(const RunRecord& record);

  /// The run of that number, or null.
  const Run* find(int number) const;

  /// The run that is shown, or null.
  const Run* shown() const { return shown_ ? find(*shown_) : nullptr; }

  /// The prediction of the shown run for a cloud, or null.
  std::shared_ptr<const Prediction> prediction(std::size_t cloud) const;

  /// The same, but throws Error(kInsufficient) if that run is being trained again.
  std::shared_ptr<const Prediction> settled_prediction(std::size_t cloud) const;

  /// The number of predictions so far.
  int version() const { return version_; }

  /// Shows a run, which must have a prediction; it replaces the one of its number.
  void show(Run run);

  /// Sets the accuracy of the run of that number, if it exists, on held-out strokes.
  void judge(int number, const HeldOut& held_out);

  /// Shows a run that was remembered and is being trained again.
  void await(int number) { shown_ = number; }

  /// Forgets the predictions of a start.
  void forget_start();

  /// Shows no run if the shown one was to be trained again.
  void stop_awaiting();

  std::vector<RunView> views() const;
  std::optional<RunView> shown_view() const;

 private:
  std::vector<Run> runs_;
  std::optional<int> shown_;
  int version_ = 0;
};

}  // namespace pcednet::annotate
