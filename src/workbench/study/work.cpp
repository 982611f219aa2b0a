#include "workbench/study/work.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "pcednet/core/digest.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/train_context.h"
#include "workbench/shapes/perturb.h"

namespace pcednet::study {
namespace {

// The treatment of a cloud is the experiment; nothing is repaired.
const detect::PrepareOptions kAsGiven = {.keep_orientation = true};

/// The labels of the points to learn from, chosen by their positions.
std::vector<std::uint8_t> thinned_labels(const PointCloud& cloud, int one_in) {
  std::vector<std::uint8_t> labels = cloud.labels;
  if (one_in <= 1) return labels;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto lanes = Digest().add_values(std::span(&cloud.positions[i], 1)).lanes();
    if (lanes[0] % static_cast<std::uint64_t>(one_in) != 0) labels[i] = kUnlabelled;
  }
  return labels;
}

PointCloud treat(const PointCloud& cloud, const Treatment& treatment) {
  PointCloud treated = cloud;
  if (treatment.keep < 1.0) treated = shapes::subsample(treated, {.fraction = treatment.keep});
  if (treatment.noise > 0.0) {
    if (treatment.along_normal && !treated.has_normals()) {
      const auto prepared = detect::prepare(treated, kAsGiven);
      treated.normals.assign(prepared.normals.begin(), prepared.normals.end());
    }
    treated = shapes::add_gaussian_noise(
        std::move(treated), {.sigma = treatment.noise, .along_normal = treatment.along_normal});
  }
  if (treatment.estimate_normals) treated.normals.clear();
  return treated;
}

/// The MCC of edge against non-edge, or of sharp-edge where there is no smooth class. Rows are true
/// classes, columns predicted ones.
double mcc_of(const std::vector<std::size_t>& confusion) {
  const auto classes = static_cast<std::size_t>(std::sqrt(static_cast<double>(confusion.size())));
  eval::ConfusionCounts counts;
  for (std::size_t i = 0; i < confusion.size(); ++i) {
    const bool is = i / classes > 0, said = i % classes > 0;
    (is ? (said ? counts.tp : counts.fn) : (said ? counts.fp : counts.tn)) += confusion[i];
  }
  return eval::scores_of(counts).mcc;
}

}  // namespace

void Trainer::describe(const TrainingTask& task) {
  if (samples_key_ == task.samples_key) return;
  samples_ = {};  // room for the new ones
  clouds_.clear();
  labels_.clear();
  training_ = task.training;
  for (const StudyCloud& cloud : training_->clouds) {
    labels_.push_back(thinned_labels(cloud.cloud, task.one_in));
  }
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const StudyCloud& cloud = training_->clouds[i];
    clouds_.push_back({cloud.name, detect::prepare(cloud.cloud, kAsGiven, progress_), labels_[i]});
  }
  EnergyMeter meter(watts_per_core_);
  samples_ = detect::make_samples(clouds_, task.options.descriptor, progress_);
  cost_ = meter.lap();
  samples_key_ = task.samples_key;
}

StoredModel Trainer::train(const TrainingTask& task) {
  describe(task);
  StoredModel stored;
  Stopwatch watch;
  double seconds = 0;
  const auto on_epoch = [&](const nn::EpochReport& report) {
    seconds += watch.lap();
    if (report.epoch == 1) stored.epochs.clear();  // earlier ones were a teacher's
    stored.epochs.push_back({report.epoch, seconds, report.training_loss, report.validation_loss,
                             report.validation_accuracy, mcc_of(report.validation_confusion)});
  };
  EnergyMeter meter(watts_per_core_);
  detect::TrainedModel trained =
      detect::train(task.name, samples_, task.options, on_epoch, progress_);
  if (task.options.context) detect::add_context(trained, clouds_, task.options, {}, progress_);
  if (trained.cancelled) throw Error(ErrorKind::kCancelled, "stopped by the user");
  stored.costs.train = meter.lap();
  stored.costs.describe_training = cost_;
  stored.model = std::move(trained.model);
  return stored;
}

void count_agreement(std::span<const std::uint8_t> truth, StoredClasses& found) {
  found.sharp = eval::count_confusion(truth, found.classes, eval::Positive::kSharp);
  found.edge = eval::count_confusion(truth, found.classes, eval::Positive::kEdge);
}

CloudWork::CloudWork(const StudyCloud& cloud, const Treatment& treatment,
                     const gls::ScaleSpaceOptions& descriptor, double watts_per_core,
                     const Progress* progress)
    : watts_per_core_(watts_per_core) {
  try {
    PointCloud treated = treat(cloud.cloud, treatment);
    truth_ = treated.labels;
    EnergyMeter meter(watts_per_core_);
    const auto prepared = detect::prepare(treated, kAsGiven, progress);
    costs_.normals = meter.lap();
    described_ = detect::describe(prepared, descriptor, progress);
    costs_.describe = meter.lap();
    positions_ = std::move(treated.positions);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInsufficient) throw;
    failure_ = error.what();
  }
}

StoredClasses CloudWork::classify(const detect::EdgeModel& model) const {
  StoredClasses stored{.failure = failure_, .costs = costs_};
  if (!failure_.empty()) return stored;
  EnergyMeter meter(watts_per_core_);
  stored.classes = detect::classify(described_, positions_, model).classes;
  stored.costs.classify = meter.lap();
  count_agreement(truth_, stored);
  return stored;
}

StoredClasses classify_classic(const StudyCloud& cloud, const std::string& set,
                               const Treatment& treatment, const ClassicMethod& method,
                               double watts_per_core, const Progress* progress) {
  StoredClasses stored;
  try {
    const PointCloud treated = treat(cloud.cloud, treatment);
    EnergyMeter meter(watts_per_core);
    stored.classes = method.classes(treated, set, progress);
    stored.costs.describe = meter.lap();
    count_agreement(treated.labels, stored);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInsufficient) throw;
    stored.failure = error.what();
  }
  return stored;
}

eval::Predictions external_classes(const ExternalMethod& method, const std::string& set,
                                   const StudyCloud& cloud) {
  constexpr std::string_view kSet = "{set}";
  std::string folder = method.folder;
  if (const std::size_t place = folder.find(kSet); place != std::string::npos) {
    folder.replace(place, kSet.size(), set);
  }
  const std::filesystem::path file = eval::find_predictions(folder, cloud.name, cloud.file);
  if (file.empty()) return {};
  auto predictions = eval::read_predictions(file, cloud.cloud.positions);
  if (!predictions.note.empty()) {
    predictions.note = fmt::format("{}: {}", file.string(), predictions.note);
  }
  return predictions;
}

}  // namespace pcednet::study
