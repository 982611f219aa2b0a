#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "evaluate_lines.h"
#include "las_codes.h"
#include "methods.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/classify.h"
#include "pcednet/eval/predictions.h"
#include "pcednet/eval/report.h"
#include "pcednet/formats/format.h"
#include "result_plan.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::vector<std::string> inputs;
  std::string predictions, json, truth, cloud, las_classification;
  LasCodes codes = {};
  eval::Positive positive = eval::Positive::kSharp;
  ModelArguments model;
  MethodArguments method;
  detect::PrepareOptions preparation;
  bool calibration = false;
};

/// How many points are edges.
struct Edges {
  std::size_t smooth = 0, sharp = 0;
};

struct Results {
  std::vector<eval::CloudScore> scores;
  Edges labelled, found;
  eval::Calibration calibration;
  eval::ClassReport classes;  ///< instead of both, with own classes
  std::string classes_from;   ///< what settled the table of the classes; empty: nothing yet
};

/// A cloud whose classes are not those that are scored.
struct OtherClasses : Error {
  using Error::Error;
};

std::vector<std::uint8_t> read_predictions(const fs::path& file, const PointCloud& cloud,
                                           const ClassTable& table) {
  auto predictions = eval::read_predictions(file, cloud.positions, table);
  if (!predictions.note.empty()) warn(file.string() + ": " + predictions.note);
  return std::move(predictions.classes);
}

/// The probability of the positive classes, per point.
std::vector<float> probabilities(const detect::Classification& found, eval::Positive positive) {
  std::vector<float> p = found.p_sharp;
  if (positive == eval::Positive::kEdge) {
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += found.p_smooth[i];
  }
  return p;
}

void count_edges(std::span<const std::uint8_t> classes, Edges& edges) {
  edges.smooth += static_cast<std::size_t>(std::ranges::count(classes, kSmoothEdge));
  edges.sharp += static_cast<std::size_t>(std::ranges::count(classes, kSharpEdge));
}

/// Warns of labels or predictions that mark edges by 1, which score 0.
void warn_of_edges(const char* whose, const Edges& edges, eval::Positive positive) {
  const std::string note = eval::none_is_positive(edges.smooth, edges.sharp, positive);
  if (!note.empty()) warn(fmt::format("{}: {}", whose, note));
}

/// How the classes of a cloud are found.
struct Way {
  const EvaluateArguments& arguments;
  const detect::EdgeModel* model;  ///< none: a method, or predictions
  const Progress& progress;
};

/// Those of `input` by the model or the method, or of the file `prediction` if it is named.
detect::Classification find_classes(const fs::path& input, const fs::path& prediction,
                                    const PointCloud& cloud, const ClassTable& table,
                                    const Way& way) {
  if (!prediction.empty()) {
    detect::Classification found;
    found.classes = read_predictions(prediction, cloud, table);
    return found;
  }
  return all_points(classify_cloud(input, cloud,
                                   {.model = way.model,
                                    .method = way.arguments.method,
                                    .preparation = way.arguments.preparation,
                                    .boundary = !way.arguments.model.no_boundary},
                                   way.progress))
      .found;
}

void score(const fs::path& input, const PointCloud& cloud, const detect::Classification& found,
           const Way& way, Results& results) {
  const eval::Positive positive = way.arguments.positive;
  if (has_own_classes(results.classes.table)) {
    return eval::add_cloud(cloud.labels, found.classes, results.classes);
  }
  count_edges(cloud.labels, results.labelled);
  count_edges(found.classes, results.found);
  results.scores.push_back(
      {formats::stem_of(input), eval::count_confusion(cloud.labels, found.classes, positive)});
  if (way.arguments.calibration) {
    eval::add_calibration(cloud.labels, probabilities(found, positive), positive,
                          results.calibration);
  }
}

/// Throws if no label is a class of the table; warns of those that are none.
void check_labels(const fs::path& input, const PointCloud& cloud, const ClassTable& table) {
  std::size_t classes = 0, others = 0;
  for (const std::uint8_t label : cloud.labels) {
    const bool is_class = label < table.size();
    classes += is_class ? 1 : 0;
    others += !is_class && label != kUnlabelled ? 1 : 0;
  }
  if (classes == 0) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: no point is labelled with a class of {}",
                                                      input.string(), pcednet::names_of(table)));
  }
  if (others == 0) return;
  warn(has_own_classes(table)
           ? fmt::format("{}: {} labels are none of the classes {}: left out", input.string(),
                         others, pcednet::names_of(table))
           : fmt::format("{}: {} labels are not edge classes (1 smooth, 2 sharp, 3 boundary): "
                         "counted as non-edge",
                         input.string(), others));
}

/// The first cloud settles the classes unless a model or a method does. The same numbers must name
/// the same classes; one table may have more of them.
void settle_classes(const fs::path& input, const PointCloud& cloud, Results& results) {
  const ClassTable its = classes_of(cloud.comments);
  ClassTable& table = results.classes.table;
  if (results.classes_from.empty()) {
    table = its;
    results.classes_from = "the first cloud";
  }
  const std::size_t common = std::min(its.size(), table.size());
  if (std::equal(its.begin(), its.begin() + static_cast<std::ptrdiff_t>(common), table.begin(),
                 [](const auto& a, const auto& b) { return a.name == b.name; })) {
    return;
  }
  throw OtherClasses(
      ErrorKind::kInsufficient,
      fmt::format("{}: its classes are {}, those of {} {}", input.string(), pcednet::names_of(its),
                  results.classes_from, pcednet::names_of(table)));
}

/// A cloud with labels of the results' classes, which the first one settles.
PointCloud read_truth(const fs::path& input, const Way& way, Results& results) {
  auto loaded = truth::read_labelled(input, way.arguments.codes);
  throw_if_cancelled(&way.progress);
  settle_classes(input, loaded.cloud, results);
  check_labels(input, loaded.cloud, results.classes.table);
  warn_all(input, loaded.warnings);
  return std::move(loaded.cloud);
}

/// The predictions for a cloud; none, with a warning, if the folder has none. Empty if the model or
/// a method predicts.
std::optional<fs::path> find_prediction(const fs::path& input, const std::string& folder) {
  if (folder.empty()) return fs::path();
  fs::path found = eval::find_predictions(folder, formats::stem_of(input), input);
  if (!found.empty()) return found;
  warn(fmt::format("{}: no prediction in {}: left out", input.string(), folder));
  return std::nullopt;
}

/// Nothing is scored yet. The classes are settled unless those of the predictions are the clouds'.
Results first_results(const EvaluateArguments& arguments, const detect::EdgeModel* model) {
  Results results;
  results.classes.table = model ? model->table : edge_classes();
  if (model) results.classes_from = "the model";
  if (!arguments.method.name.empty()) {
    results.classes_from = "--method " + arguments.method.name;
  }
  return results;
}

void check_is_folder(const std::string& predictions) {
  std::error_code ignored;
  if (predictions.empty() || fs::is_directory(predictions, ignored)) return;
  throw Error(ErrorKind::kUnreadable,
              fmt::format("--predictions {}: no such folder; there is to be a file in it for each "
                          "cloud, of the same name",
                          predictions));
}

/// Scores all inputs. Of several, those without labels are left out, with a warning each.
Results score_all(const EvaluateArguments& arguments, const Common& common) {
  const Progress progress = console_progress(common);
  check_is_folder(arguments.predictions);
  std::optional<detect::EdgeModel> model;
  if (!arguments.model.name.empty()) model = load_model(arguments.model);
  if (arguments.calibration && has_own_classes(model->table)) {
    throw Error(ErrorKind::kUsage, "evaluate: --calibration is for edge classes");
  }
  const Way way = {arguments, model ? &*model : nullptr, progress};
  Results results = first_results(arguments, way.model);
  std::optional<Error> unlabelled;  // the first
  const auto inputs = without_results(expand_inputs(arguments.inputs));
  for (const fs::path& input : inputs) {
    const auto prediction = find_prediction(input, arguments.predictions);
    if (!prediction) continue;
    PointCloud cloud;
    try {
      cloud = read_truth(input, way, results);
    } catch (const OtherClasses&) {
      throw;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kInsufficient || inputs.size() == 1) throw;
      if (!unlabelled) unlabelled = error;
      warn(fmt::format("{}: left out", error.what()));
      continue;
    }
    with_name_in_errors(input, [&] {
      const auto found = find_classes(input, *prediction, cloud, results.classes.table, way);
      score(input, cloud, found, way, results);
    });
  }
  if (!results.scores.empty() || results.classes.clouds > 0) return results;
  if (unlabelled) throw *unlabelled;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: no prediction for any cloud", arguments.predictions));
}

void evaluate(EvaluateArguments arguments, const Common& common) {
  if (!arguments.truth.empty()) {
    return evaluate_lines({arguments.inputs, arguments.truth, arguments.cloud, arguments.json},
                          common);
  }
  const int ways = !arguments.model.name.empty() + !arguments.predictions.empty() +
                   !arguments.method.name.empty();
  if (ways > 1) {
    throw Error(ErrorKind::kUsage,
                "evaluate: give one of --model, --predictions, --method or --truth");
  }
  if (ways == 0) arguments.model.name = kDefaultModel;
  arguments.codes = label_codes(arguments.las_classification);
  if (arguments.calibration && arguments.model.name.empty()) {
    throw Error(ErrorKind::kUsage, "evaluate: --calibration needs --model");
  }
  if (arguments.calibration && arguments.positive == eval::Positive::kBoundary) {
    throw Error(ErrorKind::kUsage, "evaluate: boundary has no probabilities to calibrate");
  }
  check_not_inputs(arguments.json, arguments.inputs);
  if (!arguments.predictions.empty()) check_not_inputs(arguments.json, {arguments.predictions});
  check_not_input(arguments.json, model_file(arguments.model));
  if (arguments.json != "-") check_writable(arguments.json, common.overwrite());
  const Results results = score_all(arguments, common);
  const bool own = results.classes.clouds > 0;
  warn_of_edges("the labels", results.labelled, arguments.positive);
  warn_of_edges("the predictions", results.found, arguments.positive);
  const auto json =
      own ? eval::to_json(results.classes)
          : eval::to_json(results.scores, arguments.calibration ? &results.calibration : nullptr);
  if (arguments.json == "-") {
    std::cout << json;
    return;
  }
  std::cout << (own ? eval::to_table(results.classes) : eval::to_table(results.scores));
  if (arguments.calibration) std::cout << "\n" << eval::to_table(results.calibration);
  if (!arguments.json.empty()) write_text_file(arguments.json, json, common.overwrite());
}

}  // namespace

void add_evaluate(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command =
      add_command(app, common, "evaluate",
                  "Score predicted classes against labels, or lines against true curves",
                  "pcednet evaluate clouds/ --positive edge\n"
                  "pcednet evaluate clouds/ --predictions other_tool/ --json scores.json\n"
                  "pcednet evaluate clouds/ --method ca\n"
                  "pcednet evaluate a.ply b.ply --model my.safetensors --json -\n"
                  "pcednet evaluate lines.obj --truth curves.obj --cloud cloud.ply");
  command
      ->add_option("inputs", arguments->inputs,
                   "Labelled point files or folders of them; with --truth files of lines")
      ->required();
  add_model_options(*command, arguments->model);
  add_label_codes_option(*command, arguments->las_classification);
  command->add_option(
      "--predictions", arguments->predictions,
      "Folder with the labels of another program, one file per cloud with the same stem: .u8 (one "
      "byte per point), .txt (one number per line), .npy, .ply, ...");
  add_method_options(*command, arguments->method);
  CLI::Option* truth = command->add_option(
      "--truth", arguments->truth,
      "Score lines (.obj, .ply) against these true curves: a file, or a folder with STEM.obj or "
      "curves/STEM.obj, as generate writes");
  command
      ->add_option("--cloud", arguments->cloud,
                   "The cloud of the lines, or a folder of clouds with the same stems: lengths are "
                   "relative to it; without it to the box of the true curves")
      ->needs(truth);
  add_choice(*command, "--positive", arguments->positive, eval::kPositives,
             "Classes that count as positive: sharp, edge (sharp and smooth), or boundary; own "
             "classes are scored one by one");
  command->add_option("--json", arguments->json,
                      "Write the scores to this JSON file; - for standard output");
  command->add_flag("--calibration", arguments->calibration,
                    "Also compare probabilities with frequencies");
  for (const char* of_labels : {"--model", "--predictions", "--method", "--las-classification",
                                "--positive", "--calibration"}) {
    truth->excludes(command->get_option(of_labels));
  }
  add_prepare_options(*command, arguments->preparation);
  for (const char* of_a_model :
       {"--no-context", "--no-boundary", "--exact", "--s-min", "--s-max", "--keep-orientation"}) {
    for (const char* other : {"--predictions", "--method", "--truth"}) {
      command->get_option(of_a_model)->excludes(other);
    }
  }
  command->callback([arguments, &common] { evaluate(*arguments, common); });
}

}  // namespace pcednet::app
