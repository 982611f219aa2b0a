#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/nn/model.h"

namespace pcednet::nn {

/// The label of samples to leave out.
constexpr std::uint8_t kIgnoredLabel = 255;

/// Samples with the class of each; not owned.
struct TrainingSet {
  std::span<const float> samples;        ///< n x scales x features, row-major
  std::span<const std::uint8_t> labels;  ///< n; a class, or kIgnoredLabel
  /// n x classes, the probabilities to learn; empty: from the labels.
  std::span<const float> targets = {};
};

enum class OptimiserKind {
  kAdam,      ///< Kingma and Ba 2015
  kMomentum,  ///< v = momentum v + gradient; parameters -= rate v
};

/// How to train. The defaults suit sets from some dozens of labelled points to tens of millions.
struct TrainOptions {
  OptimiserKind optimiser = OptimiserKind::kAdam;
  double learning_rate = 0.01;
  bool anneal = true;  ///< let the rate rise and fall (learning_rate_share) over the epochs
  double momentum = 0.9;
  int epochs = 40;
  std::size_t batch = 512;
  /// 1: every class comes equally often, by replication; 0: as often as it occurs
  double balance = 1.0;
  /// An epoch is one round through the largest class with all others replicated, within these
  /// bounds on the number of samples.
  std::size_t least_per_epoch = 1 << 14, most_per_epoch = 1 << 20;

  bool even_validation =
      false;  ///< give every class equal weight when choosing the epoch; otherwise as in training
  double held_out = 0.1;    ///< share of every class for validation; 0: the last epoch is the best
  bool standardise = true;  ///< measure the inputs' range; otherwise they are taken as they are
  SignRule sign_rule = {};
  std::vector<std::string> class_names = {};  ///< one per class, or empty

  const Model* start = nullptr;  ///< continue from this model's weights and standardisation
  std::uint64_t seed = 1;
};

/// The paper's recipe: SGD with momentum, batches of 100, rate 0.01, 40 epochs, raw inputs.
TrainOptions paper_recipe();

/// The result of an epoch, with validation on a held-out part of every class. The validation
/// accuracy is the macro average over the classes; in the validation loss the classes weigh as in
/// training, see TrainOptions::balance, or evenly. With fewer than 20 samples of a class nothing is
/// held out: is_validated() is false, both are 0, and the last epoch counts as the best.
struct EpochReport {
  int epoch = 0;  ///< from 1
  double training_loss = 0.0;
  double validation_loss = 0.0;
  double validation_accuracy = 0.0;
  /// Confusion counts, true class by row, predicted class by column; empty without validation.
  std::vector<std::size_t> validation_confusion = {};

  bool is_validated() const { return !validation_confusion.empty(); }
};

struct TrainResult {
  Model best;  ///< of the epoch with the least validation loss
  std::vector<EpochReport> history;
  int best_epoch = 0;  ///< 0 if no epoch was completed
  bool cancelled = false;
};

/// Trains a network on labelled samples. `on_epoch` (may be empty) is called after every epoch.
///
/// When `progress` asks to stop, the best model so far is returned, marked as cancelled. The result
/// depends on the arguments alone: the same bytes for any number of threads.
/// Throws Error(kUsage) if sizes, labels or options do not fit, Error(kInsufficient) naming a class
/// without samples, unless targets are given.
TrainResult train(const Architecture& architecture, const TrainingSet& set,
                  const TrainOptions& options = {},
                  const std::function<void(const EpochReport&)>& on_epoch = {},
                  const Progress* progress = nullptr);

}  // namespace pcednet::nn
