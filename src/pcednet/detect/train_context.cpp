#include "pcednet/detect/train_context.h"

#include "pcednet/core/error.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/outputs.h"
#include "pcednet/nn/distil.h"

namespace pcednet::detect {
namespace {

/// Rows of the context matrices of all clouds, with their target outputs.
struct ContextSamples {
  std::vector<float> values = {};
  std::vector<std::uint8_t> outputs = {};
};

ContextSamples make_samples(const EdgeModel& model, std::span<const TrainingCloud> clouds,
                            const Progress* progress) {
  std::size_t points = 0;
  for (const TrainingCloud& cloud : clouds) points += cloud.labels.size();
  const Progress cancel_only = without_report(progress);
  Stage stage(progress, "look around", points);
  ContextSamples samples;
  for (const TrainingCloud& cloud : clouds) {
    const auto found = classify(cloud.cloud, model, &cancel_only);
    const ContextPlaces places(cloud.cloud.positions, cloud.cloud.curve, found);
    const ContextMatrix matrix(places, found, static_cast<int>(edge_outputs(model).size()));
    const std::size_t count = matrix.points().size();
    const std::size_t before = samples.values.size();
    samples.values.resize(before + count * matrix.width());
    matrix.describe(0, count, std::span(samples.values).subspan(before));
    for (const std::uint32_t i : matrix.points()) {
      samples.outputs.push_back(context_output_of(cloud.labels[i], model));
    }
    stage.advance(cloud.labels.size());
  }
  return samples;
}

nn::TrainResult train_context(const EdgeModel& model, std::span<const TrainingCloud> clouds,
                              const TrainOptions& options,
                              const std::function<void(const nn::EpochReport&)>& on_epoch,
                              const Progress* progress) {
  const ContextSamples samples = make_samples(model, clouds, progress);
  const std::vector<std::uint8_t> classes = edge_outputs(model);
  if (const auto missing = missing_class(classes, model.table, samples.outputs); !missing.empty()) {
    throw Error(ErrorKind::kInsufficient, "none is labelled " + missing);
  }
  const auto architecture = context_architecture(static_cast<int>(classes.size()));
  nn::TrainOptions training = options.training;
  training.sign_rule = {};
  training.class_names = model.network.class_names;
  training.class_names.resize(classes.size());
  training.start = nullptr;
  return nn::distil(architecture, {samples.values, samples.outputs}, training, options.teachers,
                    on_epoch, progress);
}

}  // namespace

void add_context(TrainedModel& trained, std::span<const TrainingCloud> clouds,
                 const TrainOptions& options,
                 const std::function<void(const nn::EpochReport&)>& on_epoch,
                 const Progress* progress) {
  if (trained.cancelled) return;
  if (edge_outputs(trained.model).size() < 2) {
    trained.notes.push_back("no context network was trained: context is of edge classes");
    return;
  }
  try {
    nn::TrainResult context = train_context(trained.model, clouds, options, on_epoch, progress);
    trained.cancelled = context.cancelled;
    if (context.best_epoch > 0) trained.model.context = std::move(context.best);
  } catch (const Error& error) {
    // The first network itself is usable.
    if (error.kind() == ErrorKind::kCancelled) {
      trained.cancelled = true;
    } else if (error.kind() == ErrorKind::kInsufficient) {
      trained.no_context = error.what();
    } else {
      throw;
    }
  }
}

}  // namespace pcednet::detect
