#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <optional>

#include "commands.h"
#include "methods.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/clean_up.h"
#include "pcednet/eval/predictions.h"
#include "pcednet/eval/report.h"
#include "pcednet/io/read_labelled.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> inputs;
  std::string model, predictions, json, positive = "sharp";
  MethodArguments method;
  bool exact = false, no_context = false, clean_up = false;
};

std::vector<std::uint8_t> predict(const fs::path& input, const PointCloud& cloud,
                                  const detect::EdgeModel* model, const Arguments& arguments,
                                  const Progress& progress) {
  if (!arguments.method.name.empty()) {
    return classify_by_method(cloud, arguments.method, &progress).classes;
  }
  const auto prepared = detect::prepare(cloud, &progress);
  for (const std::string& note : prepared.notes) warn(input.string() + ": " + note);
  auto result = detect::classify(prepared, *model, {.exact = arguments.exact}, &progress);
  if (arguments.clean_up) detect::clean_up(prepared.positions, result, {}, &progress);
  return std::move(result.classes);
}

std::vector<std::uint8_t> read_predictions(const fs::path& file, const PointCloud& cloud) {
  auto predictions = eval::read_predictions(file, cloud.positions);
  if (!predictions.note.empty()) warn(file.string() + ": " + predictions.note);
  return std::move(predictions.classes);
}

std::vector<eval::CloudScore> score_all(const Arguments& arguments, const Common& common) {
  const Progress progress = console_progress(common);
  const auto positive =
      arguments.positive == "edge" ? eval::Positive::kEdge : eval::Positive::kSharp;
  std::optional<detect::EdgeModel> model;
  if (!arguments.model.empty()) {
    model = detect::load_model(find_model(arguments.model));
    if (arguments.no_context) model->context.reset();
  }

  std::vector<eval::CloudScore> scores;
  for (const fs::path& input : expand_inputs(arguments.inputs)) {
    const bool given = !arguments.predictions.empty();
    const fs::path prediction =
        given ? eval::find_predictions(arguments.predictions, input.stem().string()) : fs::path();
    if (given && prediction.empty()) {
      warn(fmt::format("{}: no prediction in {}: left out", input.string(), arguments.predictions));
      continue;
    }
    const auto loaded = io::read_labelled(input);
    for (const std::string& warning : loaded.warnings) warn(input.string() + ": " + warning);
    with_name_in_errors(input, [&] {
      const auto classes =
          given ? read_predictions(prediction, loaded.cloud)
                : predict(input, loaded.cloud, model ? &*model : nullptr, arguments, progress);
      scores.push_back(
          {input.stem().string(), eval::count_confusion(loaded.cloud.labels, classes, positive)});
    });
  }
  if (scores.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: no prediction for any cloud", arguments.predictions));
  }
  return scores;
}

void evaluate(const Arguments& arguments, const Common& common) {
  const int ways =
      !arguments.model.empty() + !arguments.predictions.empty() + !arguments.method.name.empty();
  if (ways != 1) {
    throw Error(ErrorKind::kUsage, "evaluate: give one of --model, --predictions and --method");
  }
  const auto scores = score_all(arguments, common);
  if (arguments.json == "-") {
    std::cout << eval::to_json(scores);
    return;
  }
  std::cout << eval::to_table(scores);
  if (!arguments.json.empty()) {
    write_text_file(arguments.json, eval::to_json(scores), common.overwrite());
  }
}

}  // namespace

void add_evaluate(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_command(
      app, common, "evaluate", "Compare predicted classes with the labels in the clouds.",
      "pcednet evaluate clouds/ --model scan --positive edge\n"
      "pcednet evaluate clouds/ --predictions other_tool/ --json scores.json\n"
      "pcednet evaluate clouds/ --method ca\n"
      "pcednet evaluate a.ply b.ply --model my.safetensors --json -");
  command->add_option("inputs", arguments->inputs, "Labelled point files, or folders of them")
      ->required();
  command->add_option("--model", arguments->model, "A model's name or file to classify with");
  command->add_option("--predictions", arguments->predictions,
                      "Folder with what another program found, a file per cloud of the same stem: "
                      ".u8 (a byte a point), .txt (a number a line), .npy, .ply, ...");
  add_method_options(*command, arguments->method);
  command
      ->add_option("--positive", arguments->positive,
                   "Classes that count as positive: sharp, or edge (sharp and smooth)")
      ->capture_default_str()
      ->check(CLI::IsMember({"sharp", "edge"}));
  command->add_option("--json", arguments->json, "Write the scores here; - for standard output");
  command->add_flag("--no-context", arguments->no_context,
                    "Do not look at the answers around each point, as classify");
  command->add_flag("--clean-up", arguments->clean_up, "Let the nearest points vote, as classify");
  command->add_flag("--exact", arguments->exact, "Descriptors from exact neighbourhoods (slow)");
  command->callback([arguments, &common] { evaluate(*arguments, common); });
}

}  // namespace pcednet::app
