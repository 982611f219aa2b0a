#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/train.h"
#include "pcednet/eval/predictions.h"
#include "workbench/study/cache.h"
#include "workbench/study/plan.h"

namespace pcednet::study {

/// A network to train.
struct TrainingTask {
  std::string name;
  std::shared_ptr<const CloudSet> training;
  detect::TrainOptions options;  ///< with the seed
  int one_in;                    ///< see NetworkMethod
  std::string samples_key = {};  ///< equal for tasks that learn from the same descriptions
  std::string key = {};
};

/// Trains one network after another, and keeps clouds and descriptions of the training points for
/// the next one that learns from them.
class Trainer {
 public:
  Trainer(double watts_per_core, const Progress* progress)
      : watts_per_core_(watts_per_core), progress_(progress) {}

  /// Throws Error(kCancelled) when stopped: half a training is not kept.
  StoredModel train(const TrainingTask& task);

 private:
  void describe(const TrainingTask& task);

  double watts_per_core_;
  const Progress* progress_;
  std::string samples_key_ = {};
  std::shared_ptr<const CloudSet> training_ = {};
  std::vector<std::vector<std::uint8_t>> labels_ = {};
  std::vector<detect::TrainingCloud> clouds_ = {};  ///< of training_, with labels_
  detect::Samples samples_ = {};
  Cost cost_ = {};  ///< of describing them
};

/// Compares `found` with the labels `truth`.
void count_agreement(std::span<const std::uint8_t> truth, StoredClasses& found);

/// A treated cloud with its description, which several networks classify.
class CloudWork {
 public:
  CloudWork(const StudyCloud& cloud, const Treatment& treatment,
            const gls::ScaleSpaceOptions& descriptor, double watts_per_core,
            const Progress* progress);

  /// The classes of the treated cloud's points, and how they agree with its labels.
  StoredClasses classify(const detect::EdgeModel& model) const;

 private:
  double watts_per_core_;
  std::string failure_ = {};  ///< the reason if there is no description
  Costs costs_ = {};
  std::vector<std::uint8_t> truth_ = {};
  std::vector<Vec3> positions_ = {};
  detect::DescribedCloud described_ = {};
};

/// The predictions of a method without training for the treated cloud of the set.
StoredClasses classify_classic(const StudyCloud& cloud, const std::string& set,
                               const Treatment& treatment, const ClassicMethod& method,
                               double watts_per_core, const Progress* progress);

/// The predictions of `method` for `cloud`; no classes if there is no file for it. Throws as
/// eval::read_predictions() does.
eval::Predictions external_classes(const ExternalMethod& method, const std::string& set,
                                   const StudyCloud& cloud);

}  // namespace pcednet::study
