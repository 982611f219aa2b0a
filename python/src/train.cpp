#include "pcednet/detect/train.h"

#include <pybind11/stl.h>

#include <deque>

#include "bindings.h"
#include "clouds.h"
#include "input_cloud.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/core/named.h"
#include "pcednet/detect/points/rounding.h"
#include "text.h"
#include "workbench/annotate/learn/adapt.h"

namespace pcednet::python {
namespace {

/// A cloud to learn from, from the package.
struct LabelledArrays {
  std::string name;
  Array<double> xyz;
  bool is_float32 = false;  ///< xyz was given so
  OptionalArray<double> normals, scanners;
  Array<std::uint8_t> labels;
};

std::vector<LabelledArrays> clouds_of(const py::list& list) {
  std::vector<LabelledArrays> clouds;
  for (const py::handle entry : list) {
    const auto cloud = entry.cast<py::tuple>();
    clouds.push_back({bytes_of_text(cloud[0]), cloud[1].cast<Array<double>>(),
                      cloud[2].cast<bool>(), cloud[3].cast<OptionalArray<double>>(),
                      cloud[4].cast<OptionalArray<double>>(),
                      cloud[5].cast<Array<std::uint8_t>>()});
  }
  return clouds;
}

/// The prepared clouds, and the data they refer to.
struct TrainingClouds {
  std::deque<InputCloud> inputs;
  std::vector<detect::TrainingCloud> clouds;
  std::vector<std::string> notes;
};

/// Notes for the user on a prepared cloud.
void add_notes(const LabelledArrays& arrays, const detect::PreparedCloud& cloud,
               const gls::ScaleSpaceOptions& descriptor, std::vector<std::string>& notes) {
  for (const std::string& note : cloud.notes) notes.push_back(arrays.name + ": " + note);
  const auto extent = note_on_extent(descriptor, cloud.positions, arrays.name + ": ");
  if (!extent.empty()) notes.push_back(extent);
  if (!arrays.is_float32) return;
  with_name_in_errors(arrays.name, [&] {
    const double s_min = detect::smallest_scale(cloud, descriptor.range);
    const std::string rounded = note_on_float(true, cloud, descriptor, s_min);
    if (!rounded.empty()) notes.push_back(arrays.name + ": " + rounded);
  });
}

void prepare(const std::vector<LabelledArrays>& arrays, bool keep_orientation,
             const gls::ScaleSpaceOptions& descriptor, TrainingClouds& prepared,
             const Progress* progress) {
  for (const LabelledArrays& one : arrays) {
    const InputCloud& input = prepared.inputs.emplace_back(one.xyz, one.normals, one.scanners);
    prepared.clouds.push_back({one.name,
                               input.prepare({.keep_orientation = keep_orientation}, progress),
                               numbers(one.labels)});
    add_notes(one, prepared.clouds.back().cloud, descriptor, prepared.notes);
  }
}

detect::TrainOptions training_options_of(const py::dict& settings) {
  detect::TrainOptions options;
  constexpr std::pair<std::string_view, bool> kRecipes[] = {{"adam", false}, {"paper", true}};
  const bool is_paper = named(kRecipes, "recipe", settings["recipe"].cast<std::string>());
  if (is_paper) options.training = nn::paper_recipe();
  options.descriptor = descriptor_of(settings["descriptor"]);
  options.architecture.kind =
      named(nn::kNetworkKinds, "network", settings["network"].cast<std::string>());
  options.architecture.classes = settings["classes"].cast<int>();
  options.context = settings["context"].cast<bool>();
  options.teachers = settings["distil"].cast<int>();
  options.training.balance = settings["balance"].cast<double>();
  options.training.seed = settings["seed"].cast<std::uint64_t>();
  if (!settings["epochs"].is_none()) options.training.epochs = settings["epochs"].cast<int>();
  return options;
}

using History = std::vector<nn::EpochReport>;

py::list list_of(const History& history) {
  py::list epochs;
  for (const nn::EpochReport& report : history) {
    py::dict epoch;
    epoch["epoch"] = report.epoch;
    epoch["loss"] = report.training_loss;
    if (!report.validation_confusion.empty()) {
      epoch["validation_loss"] = report.validation_loss;
      epoch["validation_accuracy"] = report.validation_accuracy;
    }
    epochs.append(epoch);
  }
  return epochs;
}

py::tuple train(const py::list& clouds, const std::vector<std::string>& classes,
                const std::string& name, bool keep_orientation, const py::dict& settings,
                const py::object& progress, int threads) {
  const auto arrays = clouds_of(clouds);
  detect::TrainOptions options = training_options_of(settings);
  options.table = table_of_lines(classes);
  TrainingClouds prepared;
  detect::TrainedModel trained;
  History history;
  std::vector<detect::NamedLabels> labels;
  for (const LabelledArrays& one : arrays) labels.push_back({one.name, numbers(one.labels)});
  run_job({progress, threads}, [&](const Progress* job) {
    detect::check_labels(labels, options);
    prepare(arrays, keep_orientation, options.descriptor, prepared, job);
    trained = detect::train(
        name, prepared.clouds, options,
        [&](const nn::EpochReport& report) { history.push_back(report); }, job);
  });
  std::vector<std::string>& notes = prepared.notes;
  notes.insert(notes.end(), trained.notes.begin(), trained.notes.end());
  if (!trained.no_context.empty()) {
    notes.push_back("no context network was trained: the first network left no point in doubt: " +
                    trained.no_context);
  }
  return py::make_tuple(std::move(trained.model), list_of(history), texts_of(notes));
}

/// Fine-tunes on painted points, as the annotator does: see annotate::adapt_clouds().
py::tuple adapt(const detect::EdgeModel& model, const py::list& clouds,
                const std::vector<std::string>& classes, const std::string& name,
                bool keep_orientation, std::uint64_t seed, const py::object& progress,
                int threads) {
  const auto arrays = clouds_of(clouds);
  const ClassTable table = table_of_lines(classes);
  annotate::check_classes_of_start(model, table);
  TrainingClouds prepared;
  detect::TrainedModel adapted;
  History history;
  run_job({progress, threads}, [&](const Progress* job) {
    prepare(arrays, keep_orientation, model.descriptor, prepared, job);
    adapted = annotate::adapt_clouds(
        name, model, prepared.clouds, table, seed,
        [&](const nn::EpochReport& report) { history.push_back(report); }, job);
  });
  return py::make_tuple(std::move(adapted.model), list_of(history), texts_of(prepared.notes));
}

}  // namespace

void add_train(py::module_& module) {
  module.def("train", train);
  module.def("adapt", adapt);
}

}  // namespace pcednet::python
