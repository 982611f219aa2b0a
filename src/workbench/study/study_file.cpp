#include "workbench/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/version.h"
#include "pcednet/io/input_file.h"

namespace pcednet::study {
namespace {

namespace fs = std::filesystem;

using enum eval::Positive;

/// A row of a table of Himeur et al. 2021: medians over their clouds of a set, trained on Default.
struct PublishedRow {
  std::string_view set;      ///< default, abc or shrec
  std::string_view variant;  ///< of the experiment "methods"
  eval::Positive positive;
  eval::Scores median;
};

constexpr PublishedRow kPublished[] = {
    {"default", "ca", kEdge, {.490, .880, .506, .628, .752, .457}},
    {"default", "fee", kEdge, {.341, .814, .471, .480, .879, .316}},
    {"default", "fc", kEdge, {.618, .958, .682, .753, .849, .604}},
    {"default", "cnn", kEdge, {.546, .955, .623, .694, .807, .532}},
    {"default", "pcednet", kEdge, {.826, .952, .857, .890, .946, .802}},
    {"default", "pcednet-2c", kSharp, {.364, .611, .402, .430, .908, .274}},
    {"abc", "ca", kSharp, {.348, .944, .520, .504, .881, .338}},
    {"abc", "fee", kSharp, {.135, 1.000, .062, .235, .278, .132}},
    {"abc", "fc", kSharp, {.452, .679, .469, .513, .921, .327}},
    {"abc", "cnn", kSharp, {.530, .995, .648, .689, .922, .519}},
    {"abc", "pcednet", kSharp, {.746, .745, .688, .713, .966, .548}},
    {"abc", "pcednet-2c", kSharp, {.662, .936, .708, .730, .958, .574}},
    {"shrec", "ca", kSharp, {.434, .449, .390, .442, .876, .284}},
    {"shrec", "fee", kSharp, {.191, .527, .151, .278, .727, .160}},
    {"shrec", "fc", kSharp, {.392, .538, .391, .455, .880, .294}},
    {"shrec", "fc", kEdge, {.313, .909, .428, .461, .793, .300}},
    {"shrec", "cnn", kSharp, {.468, .928, .570, .611, .911, .440}},
    {"shrec", "cnn", kEdge, {.299, .945, .429, .446, .802, .287}},
    {"shrec", "pcednet-2c", kSharp, {.462, .623, .455, .510, .868, .342}},
    {"shrec", "pcednet", kSharp, {.495, .377, .344, .437, .916, .280}},
    {"shrec", "pcednet", kEdge, {.349, .898, .444, .489, .814, .323}},
};

const char* name_of(eval::Positive positive) {
  return positive == eval::Positive::kEdge ? "edge" : "sharp";
}

/// As seen from the study's folder, so that a report can be made from anywhere.
std::string seen_from(const fs::path& folder, const std::string& file) {
  if (folder.empty() || fs::path(file).is_absolute()) return file;
  return fs::proximate(file, folder).string();
}

OrderedJson sets_of(const Study& study, const fs::path& folder) {
  OrderedJson sets = OrderedJson::array();
  for (const auto& set : study.sets) {
    OrderedJson clouds = OrderedJson::array();
    for (const StudyCloud& cloud : set->clouds) {
      if (cloud.file.empty()) continue;  // not available to a page
      clouds.push_back({{"name", cloud.name},
                        {"points", cloud.cloud.size()},
                        {"file", seen_from(folder, cloud.file)}});
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
  for (const PublishedRow& row : kPublished) {
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

/// A variant on a set: its seeds.
using Group = std::vector<const Result*>;

std::vector<Group> groups_of(const Study& study) {
  std::vector<Group> groups;
  for (const Result& result : study.results) {
    const auto same = [&](const Group& group) {
      return group[0]->variant == result.variant && group[0]->set == result.set &&
             group[0]->positive == result.positive;
    };
    const auto place = std::find_if(groups.begin(), groups.end(), same);
    if (place == groups.end()) {
      groups.push_back({&result});
    } else {
      place->push_back(&result);
    }
  }
  std::stable_sort(groups.begin(), groups.end(), [&](const Group& a, const Group& b) {
    const auto rank = [&](const Group& group) {
      const auto is_set = [&](const auto& set) { return set->name == group[0]->set; };
      return std::find_if(study.sets.begin(), study.sets.end(), is_set) - study.sets.begin();
    };
    return rank(a) < rank(b);
  });
  return groups;
}

/// ".842" or ".842 +- .011".
std::string spread(const Group& group, double (*value)(const Result&)) {
  double sum = 0, squares = 0;
  for (const Result* result : group) sum += value(*result);
  const double mean = sum / static_cast<double>(group.size());
  if (group.size() == 1) return fmt::format("{:.3f}", mean);
  for (const Result* result : group) squares += std::pow(value(*result) - mean, 2);
  return fmt::format("{:.3f} +-{:.3f}", mean,
                     std::sqrt(squares / static_cast<double>(group.size() - 1)));
}

std::string score_row(const Group& group) {
  return fmt::format(
      " {:>13} {:>13} {:>13} {:>13} {:>13} {:>13}",
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).precision; }),
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).recall; }),
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).mcc; }),
      spread(group, [](const Result& r) { return eval::median_scores(r.scores).f1; }),
      spread(group, [](const Result& r) { return scores_of(eval::pooled_counts(r.scores)).mcc; }),
      spread(group, [](const Result& r) { return scores_of(eval::pooled_counts(r.scores)).f1; }));
}

std::string mean(const Group& group, Cost Costs::*part) {
  double sum = 0;
  for (const Result* result : group) sum += (result->costs.*part).seconds;
  return fmt::format(" {:>9.3f}", sum / static_cast<double>(group.size()));
}

/// The mean energy of the variant's phase; "-" where a variant is no single phase.
std::string mean_joules(const Group& group, Phase phase) {
  double sum = 0;
  for (const Result* result : group) {
    const auto joules = joules_per_thousand(*result, phase);
    if (!joules) return fmt::format(" {:>14}", "-");
    sum += *joules;
  }
  return fmt::format(" {:>14.4g}", sum / static_cast<double>(group.size()));
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

std::string to_json(const Study& study, const FileOptions& options, const fs::path& folder) {
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
  json["sets"] = sets_of(study, folder);
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
  write_text_file(file_of(folder, name), to_json(study, options, folder), Overwrite::kYes);
}

std::string to_table(const Study& study) {
  const bool scored = !study.experiment.timed;
  std::string table, set;
  for (const Group& group : groups_of(study)) {
    const Result& first = *group[0];
    if (set != first.set || table.empty()) {
      set = first.set;
      table += fmt::format("\n{:<24} {:>6}", study.experiment.name + ": " + set, "edge");
      if (scored) {
        table += fmt::format(" {:>13} {:>13} {:>13} {:>13} {:>13} {:>13}", "median P", "R", "MCC",
                             "F1", "pooled MCC", "F1");
      }
      table += fmt::format(" {:>9} {:>9} {:>9}  seconds", "describe", "train", "classify");
      table += scored ? "\n" : "  joules per 1000 points\n";
    }
    table += fmt::format("{:<24} {:>6}", study.experiment.variants[first.variant].id,
                         first.positive == eval::Positive::kEdge ? "both" : "sharp");
    if (scored) table += score_row(group);
    table +=
        mean(group, &Costs::describe) + mean(group, &Costs::train) + mean(group, &Costs::classify);
    if (!scored) {
      const Phase phase = study.experiment.variants[first.variant].phase;
      table += "         " + mean_joules(group, phase);
    }
    table += "\n";
  }
  return table;
}

}  // namespace pcednet::study
