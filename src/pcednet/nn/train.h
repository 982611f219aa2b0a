#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/nn/model.h"
#include "pcednet/nn/optimiser.h"
#include "pcednet/nn/training_set.h"

namespace pcednet::nn {

/// How to train. The defaults suit sets from some dozens of labelled points to tens of millions.
struct TrainOptions {
  OptimiserKind optimiser = OptimiserKind::kAdam;
  double learning_rate = 0.01;
  bool anneal = true;  ///< let the rate rise and fall (learning_rate_share) over the epochs
  double momentum = 0.9;
  double weight_decay = 0.0;
  double label_smoothing = 0.0;
  double missing_scales = 0.0;  ///< the share of samples that lose some scales at either end
  int epochs = 40;
  std::size_t batch = 512;
  /// 1: every class comes equally often, by replication; 0: as often as it occurs; see Sampler
  double balance = 1.0;
  /// An epoch is one round through the largest class with all others replicated, but at least and
  /// at most so many samples.
  std::size_t least_per_epoch = 1 << 14, most_per_epoch = 1 << 20;

  bool standardise = true;  ///< measure the inputs' range; otherwise they are taken as they are
  StandardisationOptions standardisation = {};
  SignRule sign_rule = {};
  std::vector<std::string> class_names = {};  ///< one per class, or empty

  /// Samples to judge the epochs by. If empty, `validation_share` of every class is kept apart for
  /// it; with fewer than 20 samples of a class there is no validation and the last epoch counts.
  TrainingSet validation = {};
  double validation_share = 0.1;
  int patience = 0;  ///< epochs without a better validation loss before stopping; 0: never stop

  const Model* start = nullptr;  ///< continue from this model's weights and standardisation
  std::uint64_t seed = 1;
};

/// What the paper did: SGD with momentum, batches of 100, rate 0.01, 40 epochs, raw inputs.
TrainOptions paper_recipe();

/// How an epoch ended. Validation numbers are means over the classes of the mean per class, and 0
/// without validation.
struct EpochReport {
  int epoch = 0;  ///< from 1
  double training_loss = 0.0;
  double validation_loss = 0.0;
  double validation_accuracy = 0.0;
  /// How often a true class (row) was taken for one (column); empty without validation.
  std::vector<std::size_t> validation_confusion = {};
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
/// without samples.
TrainResult train(const Architecture& architecture, const TrainingSet& set,
                  const TrainOptions& options = {},
                  const std::function<void(const EpochReport&)>& on_epoch = {},
                  const Progress* progress = nullptr);

}  // namespace pcednet::nn
