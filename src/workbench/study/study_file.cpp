#include "workbench/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/version.h"
#include "pcednet/io/input_file.h"
#include "workbench/study/published.h"

namespace pcednet::study {
namespace {

namespace fs = std::filesystem;

const char* name_of(eval::Positive positive) {
  return positive == eval::Positive::kEdge ? "edge" : "sharp";
}

OrderedJson sets_of(const Study& study) {
  OrderedJson sets = OrderedJson::array();
  for (const auto& set : study.sets) {
    OrderedJson clouds = OrderedJson::array();
    for (const StudyCloud& cloud : set->clouds) {
      if (cloud.file.empty()) continue;  // not available to a page
      clouds.push_back(
          {{"name", cloud.name}, {"points", cloud.cloud.size()}, {"file", cloud.file}});
    }
    sets.push_back({{"name", set->name}, {"positive", name_of(set->positive)}, {"clouds", clouds}});
  }
  return sets;
}

const char* family_of(const Method& method) {
  if (std::holds_alternative<ExternalMethod>(method)) return "external";
  if (std::holds_alternative<ClassicMethod>(method)) return "classic";
  return "network";
}

OrderedJson variants_of(const Study& study) {
  OrderedJson variants = OrderedJson::array();
  for (std::size_t v = 0; v < study.experiment.variants.size(); ++v) {
    const Variant& variant = study.experiment.variants[v];
    OrderedJson row = {
        {"id", variant.id},      {"title", variant.title}, {"family", family_of(variant.method)},
        {"parameters", nullptr}, {"x", nullptr},           {"note", variant.note}};
    for (const Result& result : study.results) {
      if (result.variant == v && result.parameters) row["parameters"] = *result.parameters;
    }
    if (variant.x) row["x"] = *variant.x;
    variants.push_back(std::move(row));
  }
  return variants;
}

/// The parts of a variant's cost, by name.
struct PhasePart {
  Phase phase;
  const char* name;
  Cost Costs::*part;
};
constexpr PhasePart kPhases[] = {
    {Phase::kAll, "normals", &Costs::normals},
    {Phase::kDescribe, "describe", &Costs::describe},
    {Phase::kDescribeTraining, "describe_training", &Costs::describe_training},
    {Phase::kTrain, "train", &Costs::train},
    {Phase::kClassify, "classify", &Costs::classify}};

OrderedJson seconds_of(const Result& result, Phase phase) {
  OrderedJson seconds = OrderedJson::object();
  for (const auto& [own, name, part] : kPhases) {
    if (phase == Phase::kAll || phase == own) seconds[name] = (result.costs.*part).seconds;
  }
  return seconds;
}

std::string prediction_folder(const Study& study, const Result& result) {
  return fmt::format("predictions/{}/{}/{}", study.experiment.name,
                     study.experiment.variants[result.variant].id, result.set);
}

OrderedJson result_of(const Study& study, const Result& result) {
  const Variant& variant = study.experiment.variants[result.variant];
  OrderedJson row = {{"variant", variant.id}, {"set", result.set}, {"seed", nullptr}};
  if (result.seed) row["seed"] = *result.seed;
  row["positive"] = name_of(result.positive);
  if (result.scores.empty() || study.experiment.timed) {
    row["clouds"] = OrderedJson::array();
    row["median"] = row["pooled"] = nullptr;
  } else {
    row.update(parse_ordered_json(eval::to_json(result.scores)));
  }
  row["seconds"] = seconds_of(result, variant.phase);
  row["joules"] = nullptr;
  if (const auto joules = joules_per_thousand(result, variant.phase)) row["joules"] = *joules;
  row["predictions"] = nullptr;
  if (!result.classes.empty()) row["predictions"] = prediction_folder(study, result);
  return row;
}

OrderedJson curves_of(const Study& study) {
  OrderedJson curves = OrderedJson::array();
  for (const Curve& curve : study.curves) {
    OrderedJson epochs = OrderedJson::array();
    for (const EpochPoint& point : curve.epochs) {
      epochs.push_back({{"epoch", point.epoch},
                        {"seconds", point.seconds},
                        {"loss", point.loss},
                        {"held_out_loss", point.held_out_loss},
                        {"held_out_accuracy", point.held_out_accuracy},
                        {"held_out_mcc", point.held_out_mcc}});
    }
    curves.push_back({{"variant", study.experiment.variants[curve.variant].id},
                      {"seed", curve.seed},
                      {"epochs", std::move(epochs)}});
  }
  return curves;
}

/// The published scores of these methods, trained as here, on sets of these names.
OrderedJson expected_of(const Study& study) {
  OrderedJson expected = OrderedJson::array();
  if (study.experiment.name != "methods" || study.training != "default") return expected;
  for (const PublishedRow& row : published_rows()) {
    const auto is_row = [&](const Result& result) {
      return study.experiment.variants[result.variant].id == row.variant && result.set == row.set &&
             result.positive == row.positive;
    };
    if (std::none_of(study.results.begin(), study.results.end(), is_row)) continue;
    const eval::Scores& s = row.median;
    expected.push_back({{"variant", row.variant},
                        {"set", row.set},
                        {"positive", name_of(row.positive)},
                        {"published",
                         {{"median",
                           {{"precision", s.precision},
                            {"recall", s.recall},
                            {"mcc", s.mcc},
                            {"f1", s.f1},
                            {"accuracy", s.accuracy},
                            {"iou", s.iou}}}}},
                        {"source", "Himeur et al. 2021, median over all clouds of their set"}});
  }
  return expected;
}

fs::path file_of(const fs::path& folder, const std::string& name) {
  return folder / (name + ".json");
}

/// Whether the file holds the study that this command makes.
bool is_of_command(const fs::path& file, const std::string& command) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  try {
    const Json study = parse_json(io::InputFile(file).text());
    return study.is_object() && study.value("command", "") == as_utf8(command);
  } catch (const Json::exception&) {
    return false;
  }
}

}  // namespace

std::optional<double> joules_per_thousand(const Result& result, Phase phase) {
  const bool training = phase == Phase::kTrain || phase == Phase::kDescribeTraining;
  const double points = training ? result.training_points : result.points;
  for (const auto& [own, name, part] : kPhases) {
    if (phase == own && phase != Phase::kAll && points > 0) {
      return 1000.0 * (result.costs.*part).joules / points;
    }
  }
  return std::nullopt;
}

std::string to_json(const Study& study, const FileOptions& options) {
  const Experiment& experiment = study.experiment;
  OrderedJson json = {{"schema", "pcednet-study-1"}, {"experiment", experiment.name},
                      {"title", experiment.title},   {"question", experiment.question},
                      {"command", options.command},  {"version", kVersion},
                      {"machine", machine_name()},   {"x_label", nullptr}};
  if (experiment.x_label) json["x_label"] = *experiment.x_label;
  if (experiment.timed) {
    json["energy"] =
        options.energy_is_measured
            ? "read from the RAPL counters of the processor"
            : fmt::format("estimated: processor seconds x {} W per core", options.watts_per_core);
  }
  json["sets"] = sets_of(study);
  json["variants"] = variants_of(study);
  json["results"] = OrderedJson::array();
  for (const Result& result : study.results) json["results"].push_back(result_of(study, result));
  json["curves"] = curves_of(study);
  json["expected"] = expected_of(study);
  json["notes"] = study.notes;
  return to_text(json, 1, NotUtf8::kReplace) + "\n";
}

void check_study_file(const fs::path& folder, const std::string& name, const std::string& command,
                      Overwrite overwrite) {
  const fs::path file = file_of(folder, name);
  if (!is_of_command(file, command)) check_writable(file, overwrite);
}

void write_study(const fs::path& folder, const Study& study, const FileOptions& options,
                 Overwrite overwrite) {
  const std::string& name = study.experiment.name;
  check_study_file(folder, name, options.command, overwrite);
  for (const Result& result : study.results) {
    if (result.classes.empty()) continue;
    const fs::path place = folder / prediction_folder(study, result);
    make_folder(place);
    for (std::size_t i = 0; i < result.classes.size(); ++i) {
      const auto& classes = result.classes[i];
      write_text_file(place / (result.scores[i].name + ".u8"),
                      {reinterpret_cast<const char*>(classes.data()), classes.size()},
                      Overwrite::kYes);
    }
  }
  write_text_file(file_of(folder, name), to_json(study, options), Overwrite::kYes);
}

}  // namespace pcednet::study
