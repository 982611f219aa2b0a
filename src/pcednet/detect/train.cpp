#include "pcednet/detect/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/octaves.h"
#include "pcednet/detect/outputs.h"
#include "pcednet/detect/train_context.h"
#include "pcednet/nn/distil.h"

namespace pcednet::detect {
namespace {

void check_label_count(const TrainingCloud& cloud) {
  if (cloud.labels.size() == cloud.cloud.positions.size()) return;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: {} labels for {} points", cloud.name, cloud.labels.size(),
                          cloud.cloud.positions.size()));
}

void check_is_labelled(const NamedLabels& cloud, const ClassTable& table) {
  if (std::any_of(cloud.labels.begin(), cloud.labels.end(),
                  [&](std::uint8_t label) { return is_learnt_from(label, table); })) {
    return;
  }
  std::string classes;
  for (std::size_t id = 0; id < table.size(); ++id) {
    classes += fmt::format("{}{} {}", id == 0 ? "" : ", ", id, table[id].name);
  }
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: no labelled point ({})", cloud.name, classes));
}

/// The labelled points in the engine's order, which does not depend on their numbering.
std::vector<std::uint32_t> labelled_points(const TrainingCloud& cloud,
                                           std::span<const std::uint32_t> order,
                                           const ClassTable& table) {
  std::vector<std::uint32_t> points;
  std::copy_if(order.begin(), order.end(), std::back_inserter(points),
               [&](std::uint32_t i) { return is_learnt_from(cloud.labels[i], table); });
  return points;
}

/// The classes of a network's outputs; only occurring ones of own classes.
std::vector<std::uint8_t> classes_of(const nn::Architecture& architecture, const ClassTable& table,
                                     std::span<const std::uint8_t> labels) {
  if (has_own_classes(table)) {
    std::set<std::uint8_t> ids(labels.begin(), labels.end());
    if (has_edges(table) && ids.erase(kBoundary) > 0) ids.insert(kNonEdge);
    return {ids.begin(), ids.end()};
  }
  if (architecture.classes == 2) return {kNonEdge, kSharpEdge};
  if (architecture.classes == 3) return {kNonEdge, kSmoothEdge, kSharpEdge};
  throw Error(ErrorKind::kUsage,
              fmt::format("{} classes: 2 or 3 are possible", architecture.classes));
}

/// The classes of the outputs of a network that learns from points with these labels. Throws
/// Error(kInsufficient) if a class has none.
std::vector<std::uint8_t> classes_to_learn(std::span<const std::uint8_t> labels,
                                           const TrainOptions& options) {
  EdgeModel model;
  model.table = options.table;
  model.classes = classes_of(options.architecture, options.table, labels);
  if (model.classes.size() == 1) {
    const std::uint8_t only = model.classes.front();
    throw Error(ErrorKind::kInsufficient,
                fmt::format("all labelled points are {} ({}): two classes are needed",
                            model.table[only].name, only));
  }
  std::vector<std::uint8_t> outputs;
  for (const std::uint8_t label : labels) outputs.push_back(output_of(label, model));
  if (const auto missing = missing_class(model.classes, model.table, outputs); !missing.empty()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("no point is labelled {}", missing));
  }
  return model.classes;
}

std::vector<std::string> class_names(const EdgeModel& model) {
  std::vector<std::string> names;
  for (const std::uint8_t c : model.classes) names.push_back(model.table[c].name);
  return names;
}

/// Every feature but phi changes sign with the normals.
nn::SignRule sign_rule(const gls::ScaleSpaceOptions& descriptor, nn::Symmetry symmetry) {
  nn::SignRule rule;
  rule.symmetry = symmetry;
  const auto names = gls::column_names(descriptor);
  for (std::size_t i = 0; i < names.size(); ++i) {
    rule.odd_features.push_back(names[i].ends_with("phi") ? 0 : 1);
    if (names[i] == "kappa") rule.deciding_feature = static_cast<int>(i);
  }
  return rule;
}

bool is_validated(const nn::TrainResult& result) {
  return !result.history.empty() && result.history.back().is_validated();
}

std::map<std::string, std::string> summary_of(const nn::TrainResult& result,
                                              const Samples& samples) {
  std::map<std::string, std::string> summary;
  summary["training_clouds"] = std::to_string(samples.clouds);
  summary["training_points"] = std::to_string(samples.points);
  summary["training_samples"] = std::to_string(samples.labels.size());
  summary["training_epochs"] = std::to_string(result.history.size());
  if (is_validated(result)) {
    const auto best = std::min_element(
        result.history.begin(), result.history.end(),
        [](const auto& a, const auto& b) { return a.validation_loss < b.validation_loss; });
    summary["validation_loss"] = fmt::format("{:.4f}", best->validation_loss);
    summary["validation_accuracy"] = fmt::format("{:.4f}", best->validation_accuracy);
  }
  return summary;
}

}  // namespace

void check_labels(std::span<const NamedLabels> clouds, const TrainOptions& options) {
  std::set<std::uint8_t> present;
  for (const NamedLabels& cloud : clouds) {
    check_is_labelled(cloud, options.table);
    for (const std::uint8_t label : cloud.labels) {
      if (is_learnt_from(label, options.table)) present.insert(label);
    }
  }
  classes_to_learn(std::vector<std::uint8_t>(present.begin(), present.end()), options);
}

Samples make_samples(std::span<const TrainingCloud> clouds,
                     const gls::ScaleSpaceOptions& descriptor, const Progress* progress,
                     const ClassTable& table) {
  const std::size_t width = row_width(descriptor);
  const Progress cancel_only = without_report(progress);
  Samples samples{.descriptor = descriptor, .clouds = clouds.size()};
  for (const TrainingCloud& cloud : clouds) samples.points += cloud.cloud.positions.size();
  Stage stage(progress, "describe", samples.points);
  for (const TrainingCloud& cloud : clouds) {
    with_name_in_errors(cloud.name, [&] { check_consistent(cloud.cloud); });
    check_label_count(cloud);
    check_is_labelled({cloud.name, cloud.labels}, table);
    const auto positions = cloud.cloud.positions;
    const auto add_octave = [&](const gls::ScaleSpace& space, std::span<const std::uint32_t> all) {
      if (const auto note = gls::note_on(descriptor, space.scales(), positions); !note.empty()) {
        samples.notes.push_back(fmt::format("{}: {}", cloud.name, note));
      }
      const auto points = labelled_points(cloud, all, table);
      const std::size_t before = samples.values.size();
      samples.values.resize(before + points.size() * width);
      describe(space, points, std::span(samples.values).subspan(before), &cancel_only);
      for (const std::uint32_t i : points) samples.labels.push_back(cloud.labels[i]);
    };
    with_name_in_errors(
        cloud.name, [&] { for_each_octave(cloud.cloud, descriptor, &cancel_only, add_octave); });
    stage.advance(positions.size());
  }
  return samples;
}

TrainedModel train(const std::string& name, std::span<const TrainingCloud> clouds,
                   const TrainOptions& options,
                   const std::function<void(const nn::EpochReport&)>& on_epoch,
                   const Progress* progress) {
  std::vector<NamedLabels> labels;
  for (const TrainingCloud& cloud : clouds) labels.push_back({cloud.name, cloud.labels});
  check_labels(labels, options);
  const Samples samples = make_samples(clouds, options.descriptor, progress, options.table);
  TrainedModel trained = train(name, samples, options, on_epoch, progress);
  trained.notes = samples.notes;
  // The context network learns from the descriptions that the network learnt from.
  trained.model.descriptor.range.rounded = samples.descriptor.range.rounded;
  if (options.context) add_context(trained, clouds, options, on_epoch, progress);
  trained.model.descriptor.range.rounded = true;
  return trained;
}

TrainedModel train(const std::string& name, const Samples& samples, const TrainOptions& options,
                   const std::function<void(const nn::EpochReport&)>& on_epoch,
                   const Progress* progress) {
  TrainedModel trained;
  EdgeModel& model = trained.model;
  model.name = name;
  model.seed = options.training.seed;
  model.descriptor = samples.descriptor;
  model.table = options.table;
  model.classes = classes_to_learn(samples.labels, options);

  nn::Architecture architecture = options.architecture;
  architecture.classes = static_cast<int>(model.classes.size());
  architecture.scales = model.descriptor.scales;
  architecture.features = gls::column_count(model.descriptor);
  // Twice as many numbers are no reason for twice as many neurons.
  if (model.descriptor.second_gate && architecture.width == 0) {
    architecture.width = gls::feature_count(model.descriptor.features);
  }

  nn::TrainOptions training = options.training;
  training.sign_rule = sign_rule(model.descriptor, options.symmetry);
  training.class_names = class_names(model);
  std::vector<std::uint8_t> outputs;
  for (const std::uint8_t label : samples.labels) {
    outputs.push_back(output_of(label, model));
  }
  nn::TrainResult result = nn::distil(architecture, {samples.values, outputs}, training,
                                      options.teachers, on_epoch, progress);
  trained.cancelled = result.cancelled;
  trained.epochs = static_cast<int>(result.history.size());
  trained.validated = is_validated(result);
  model.network = std::move(result.best);
  model.network.metadata = summary_of(result, samples);
  model.descriptor.range.rounded = true;
  return trained;
}

}  // namespace pcednet::detect
