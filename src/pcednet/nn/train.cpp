#include "pcednet/nn/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/nn/gradient.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/optimiser.h"
#include "pcednet/nn/sampler.h"
#include "pcednet/nn/standardise.h"
#include "pcednet/nn/validate.h"

namespace pcednet::nn {
namespace {

using SamplesByClass = std::vector<std::vector<std::uint32_t>>;

// Independent streams of the caller's seed.
enum Stream : std::uint64_t { kSplitStream = 1, kSampleStream = 2 };

constexpr std::size_t kFewestToSplit = 20;  // samples of a class
constexpr std::size_t kMostToValidate =
    50000;  // of a class: keeps validation cheap compared with training

std::string name_of_class(const TrainOptions& options, std::size_t c) {
  if (c < options.class_names.size()) return fmt::format("{} ({})", c, options.class_names[c]);
  return fmt::format("{}", c);
}

void check_options(const TrainOptions& o) {
  const auto need = [](bool good, const char* what) {
    if (!good) throw Error(ErrorKind::kUsage, fmt::format("training: {}", what));
  };
  need(o.learning_rate > 0.0, "the learning rate must be positive");
  need(o.momentum >= 0.0 && o.momentum < 1.0, "the momentum must be in [0, 1)");
  need(o.balance >= 0.0 && o.balance <= 1.0, "the balance must be in [0, 1]");
  need(o.held_out >= 0.0 && o.held_out < 1.0, "the share held out must be in [0, 1)");
  need(o.epochs > 0 && o.batch > 0, "at least one epoch and batches of one sample are needed");
  need(o.most_per_epoch > 0 && o.least_per_epoch <= o.most_per_epoch,
       "the least samples per epoch exceed the most");
}

SamplesByClass sort_by_class(const Architecture& architecture, const TrainingSet& set) {
  const auto inputs = static_cast<std::size_t>(architecture.inputs());
  const auto classes = static_cast<std::size_t>(architecture.classes);
  if (set.samples.size() != set.labels.size() * inputs) {
    throw Error(ErrorKind::kUsage, fmt::format("{} labels for {} numbers; {} inputs per sample",
                                               set.labels.size(), set.samples.size(), inputs));
  }
  if (set.labels.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::kFailure, "more samples than 32 bits can count");
  }
  SamplesByClass samples(classes);
  for (std::size_t i = 0; i < set.labels.size(); ++i) {
    const std::uint8_t label = set.labels[i];
    if (label == kIgnoredLabel) continue;
    if (label >= classes) {
      throw Error(
          ErrorKind::kUsage,
          fmt::format("sample {} is labelled {}; the network has {} classes", i, label, classes));
    }
    samples[label].push_back(static_cast<std::uint32_t>(i));
  }
  return samples;
}

std::vector<std::uint32_t> concatenate(const SamplesByClass& samples, std::size_t most) {
  std::vector<std::uint32_t> all;
  for (const auto& of_class : samples) {
    const std::size_t stride = std::max<std::size_t>(1, (of_class.size() + most - 1) / most);
    for (std::size_t i = 0; i < of_class.size(); i += stride) all.push_back(of_class[i]);
  }
  return all;
}

/// Removes `share` of every class from `samples`; nothing if a class is too small for that.
SamplesByClass split_off(SamplesByClass& samples, double share, Random random) {
  SamplesByClass kept(samples.size());
  if (share == 0.0) return kept;
  for (const auto& of_class : samples) {
    if (of_class.size() < kFewestToSplit) return kept;
  }
  for (std::size_t c = 0; c < samples.size(); ++c) {
    random.shuffle(std::span(samples[c]));
    const auto count = static_cast<std::size_t>(share * static_cast<double>(samples[c].size()));
    kept[c].assign(samples[c].end() - static_cast<std::ptrdiff_t>(count), samples[c].end());
    samples[c].resize(samples[c].size() - count);
  }
  return kept;
}

/// The weight of each class in training, as Sampler draws them.
std::vector<double> class_weights(const SamplesByClass& samples, double balance) {
  std::vector<double> weights;
  for (const auto& of_class : samples) {
    weights.push_back(std::pow(static_cast<double>(of_class.size()), 1.0 - balance));
  }
  return weights;
}

Model make_model(const Architecture& architecture, const TrainingSet& set,
                 const TrainOptions& options) {
  if (options.start) {
    if (!(options.start->network.architecture == architecture)) {
      throw Error(ErrorKind::kUsage, "the start model has another architecture");
    }
    return *options.start;
  }
  Model model;
  model.network = make_network(architecture, options.seed);
  model.sign_rule = options.sign_rule;
  model.class_names = options.class_names;
  if (!options.standardise) {
    model.standardisation = no_standardisation(architecture.inputs());
    return model;
  }
  const bool symmetric = options.sign_rule.symmetry != Symmetry::kNone;
  const auto odd = symmetric ? std::span<const std::uint8_t>(options.sign_rule.odd_features)
                             : std::span<const std::uint8_t>();
  model.standardisation =
      measure_standardisation(set, architecture.scales, architecture.features, odd);
  return model;
}

/// The loop over the epochs, with the state that it carries.
class Trainer {
 public:
  Trainer(Model model, const TrainingSet& set, SamplesByClass samples, const TrainOptions& options)
      : options_(options),
        set_(set),
        model_(std::move(model)),
        machine_(model_),
        sampler_(std::move(samples), options.balance, Random(options.seed, kSampleStream)),
        optimiser_(options.optimiser, model_.network.parameters.size(), options.momentum),
        gradient_(model_.network.parameters.size()),
        batch_(options.batch) {
    const std::size_t samples_per_epoch =
        std::clamp(sampler_.round(), options.least_per_epoch, options.most_per_epoch);
    steps_per_epoch_ = (samples_per_epoch + options.batch - 1) / options.batch;
  }

  std::size_t steps() const { return steps_per_epoch_ * static_cast<std::size_t>(options_.epochs); }
  const Model& model() const { return model_; }

  /// One epoch; false if the caller asked to stop before its end.
  bool run_epoch(Stage& stage, const Progress* progress, double& mean_loss) {
    double sum = 0.0;
    for (std::size_t i = 0; i < steps_per_epoch_; ++i) {
      if (progress && progress->cancelled && progress->cancelled()) return false;
      sampler_.next(batch_);
      sum += machine_.run(set_, batch_, gradient_);
      const double share = options_.anneal ? learning_rate_share(step_, steps()) : 1.0;
      optimiser_.step(gradient_, options_.learning_rate * share, model_.network.parameters);
      ++step_;
      stage.advance();
    }
    mean_loss = sum / static_cast<double>(steps_per_epoch_);
    return true;
  }

 private:
  const TrainOptions& options_;
  const TrainingSet& set_;
  Model model_;
  GradientMachine machine_;
  Sampler sampler_;
  Optimiser optimiser_;
  std::vector<float> gradient_;
  std::vector<std::uint32_t> batch_;
  std::size_t steps_per_epoch_ = 0;
  std::size_t step_ = 0;
};

}  // namespace

TrainOptions paper_recipe() {
  TrainOptions options;
  options.optimiser = OptimiserKind::kMomentum;
  options.learning_rate = 0.01;
  options.anneal = false;
  options.momentum = 0.9;
  options.epochs = 40;
  options.batch = 100;
  options.least_per_epoch = 1;
  options.most_per_epoch = std::numeric_limits<std::size_t>::max();
  options.standardise = false;
  return options;
}

TrainResult train(const Architecture& architecture, const TrainingSet& set,
                  const TrainOptions& options,
                  const std::function<void(const EpochReport&)>& on_epoch,
                  const Progress* progress) {
  check_options(options);
  SamplesByClass samples = sort_by_class(architecture, set);
  for (std::size_t c = 0; c < samples.size(); ++c) {
    if (samples[c].empty() && set.targets.empty()) {
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("no sample of class {} to train on", name_of_class(options, c)));
    }
  }
  const std::vector<std::uint32_t> validation = concatenate(
      split_off(samples, options.held_out, Random(options.seed, kSplitStream)), kMostToValidate);
  const std::vector<double> weights =
      class_weights(samples, options.even_validation ? 1.0 : options.balance);

  Trainer trainer(make_model(architecture, set, options), set, std::move(samples), options);
  TrainResult result;
  Progress report_only;
  if (progress) report_only.report = progress->report;
  Stage stage(&report_only, "train", trainer.steps());
  double best_loss = std::numeric_limits<double>::infinity();
  for (int epoch = 1; epoch <= options.epochs; ++epoch) {
    EpochReport report{.epoch = epoch};
    result.cancelled = !trainer.run_epoch(stage, progress, report.training_loss);
    if (result.cancelled) break;
    if (!validation.empty()) {
      Validation found = validate(trainer.model(), set, validation, weights);
      report.validation_confusion = std::move(found.confusion);
      report.validation_loss = found.loss;
      report.validation_accuracy = found.accuracy;
    }
    result.history.push_back(report);
    if (on_epoch) on_epoch(report);
    if (validation.empty() || report.validation_loss < best_loss) {
      best_loss = report.validation_loss;
      result.best = trainer.model();
      result.best_epoch = epoch;
    }
  }
  if (result.best_epoch == 0) result.best = trainer.model();
  return result;
}

}  // namespace pcednet::nn
