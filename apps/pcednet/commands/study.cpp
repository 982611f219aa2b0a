#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <variant>

#include "batch.h"
#include "commands.h"
#include "common.h"
#include "descriptor_options.h"
#include "methods.h"
#include "models.h"
#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/formats/format.h"
#include "pcednet/io/text_scan.h"
#include "result_plan.h"
#include "workbench/shapes/default_set.h"
#include "workbench/study/study_file.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct StudyArguments {
  std::vector<std::string> names, training, tests, positives, models, predictions, methods, fee;
  std::string folder;
  std::vector<std::uint64_t> seeds;
  detect::TrainOptions networks;  ///< all but the epochs and the balance
  int epochs = 0;
  double core_watts = study::RunOptions().watts_per_core;
  bool quick = false, natural = false;
};

/// NAME=VALUE. The name is used for folders and columns.
std::pair<std::string, std::string> named(const std::string& argument, const char* option) {
  const std::size_t equals = argument.find('=');
  const std::string name = argument.substr(0, equals);
  const bool good =
      !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '-' || c == '_' || c == '.';
      });
  if (equals == std::string::npos || !good || equals + 1 == argument.size()) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} {}: give NAME=VALUE, the name of letters, digits, - and _", option,
                            argument));
  }
  return {name, argument.substr(equals + 1)};
}

study::CloudSet read_set(const std::string& name, const std::vector<std::string>& inputs,
                         const Progress& progress) {
  study::CloudSet set{.name = name};
  std::set<std::string> names;
  for (const fs::path& file : without_results(expand_inputs(inputs))) {
    throw_if_cancelled(&progress);
    auto loaded = truth::read_labelled(file);
    warn_all(file, loaded.warnings);
    const std::string stem = formats::stem_of(file);
    const std::string written = as_utf8(stem);  // in the file of the study
    if (!names.insert(written).second) {
      throw Error(ErrorKind::kUsage, fmt::format("{}: the set {} has a cloud {} already",
                                                 file.string(), name, written));
    }
    set.clouds.push_back(study::make_study_cloud(stem, file.string(), std::move(loaded.cloud)));
  }
  set.positive = study::positive_of(set.clouds);
  return set;
}

/// Without clouds if they are not needed.
study::CloudSet generated_set(bool is_needed, const Progress& progress) {
  constexpr std::uint64_t kSeed = 1;
  study::CloudSet set{.name = "default"};
  if (!is_needed) return set;
  const std::vector<shapes::Recipe> recipes = shapes::default_recipes(kSeed);
  Stage stage(&progress, "generate", recipes.size());
  for (const shapes::Recipe& recipe : recipes) {
    set.clouds.push_back(
        study::make_study_cloud(recipe.name, "", shapes::generate(recipe, kSeed).cloud));
    stage.advance();
  }
  return set;
}

study::StudyData read_data(const StudyArguments& arguments, bool trains, const Progress& progress) {
  study::StudyData data;
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> inputs;
  for (const std::string& test : arguments.tests) {
    const auto [name, input] = named(test, "--test");
    if (!inputs.contains(name)) order.push_back(name);
    inputs[name].push_back(input);
  }
  std::map<std::string, eval::Positive> positives;
  for (const std::string& positive : arguments.positives) {
    const auto [name, value] = named(positive, "--positive");
    if (value != "sharp" && value != "edge") {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--positive {}: give SET=sharp or SET=edge", positive));
    }
    if (!inputs.contains(name)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--positive {}: no set of --test is named {}", positive, name));
    }
    positives[name] = value == "edge" ? eval::Positive::kEdge : eval::Positive::kSharp;
  }
  for (const std::string& name : order) {
    auto set = read_set(name, inputs[name], progress);
    if (positives.contains(name)) set.positive = positives[name];
    data.tests.push_back(std::make_shared<const study::CloudSet>(std::move(set)));
  }
  data.training = std::make_shared<const study::CloudSet>(
      arguments.training.empty() ? generated_set(trains, progress)
                                 : read_set("training", arguments.training, progress));
  return data;
}

/// R, r and the threshold of --fee SET=R,r,THRESHOLD, for every set that has one.
std::map<std::string, MethodArguments> fee_settings(const std::vector<std::string>& given) {
  std::map<std::string, MethodArguments> settings;
  for (const std::string& argument : given) {
    const auto [set, value] = named(argument, "--fee");
    MethodArguments& fee = settings[set];
    fee.name = "fee";
    std::vector<std::optional<double>> numbers;
    for (const std::string& token : CLI::detail::split(value, ',')) {
      numbers.push_back(io::parse_double(CLI::detail::trim_copy(token)));
    }
    const bool sound = (numbers.size() == 2 || numbers.size() == 3) &&
                       std::all_of(numbers.begin(), numbers.end(), [](const auto& number) {
                         return number && std::isfinite(*number);
                       });
    if (!sound) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--fee {}: give SET=R,r or SET=R,r,THRESHOLD", argument));
    }
    fee.offset_radius = *numbers[0];
    fee.convolution_radius = *numbers[1];
    if (numbers.size() == 3) fee.threshold = *numbers[2];
  }
  return settings;
}

study::NamedMethod classic_method(const std::string& id, const std::string& title,
                                  std::map<std::string, MethodArguments> settings = {}) {
  study::NamedMethod method;
  method.id = id;
  method.title = title;
  method.method.settings = settings.empty() ? "its own settings" : "";
  for (const auto& [set, s] : settings) {
    method.method.settings +=
        fmt::format("{} R {} r {}{}; ", set, s.offset_radius, s.convolution_radius,
                    s.threshold >= 0.0 ? fmt::format(" threshold {}", s.threshold) : "");
  }
  method.method.classes = [id, settings = std::move(settings)](const PointCloud& cloud,
                                                               const std::string& set,
                                                               const Progress* progress) {
    MethodArguments arguments;
    if (const auto found = settings.find(set); found != settings.end()) arguments = found->second;
    arguments.name = id;
    return classify_by_method(cloud, arguments, progress).classes;
  };
  return method;
}

study::PlanOptions plan_of(const StudyArguments& arguments) {
  study::PlanOptions plan{.training = arguments.networks, .quick = arguments.quick};
  if (arguments.natural) plan.training.training.balance = 0.0;
  if (arguments.epochs > 0) plan.training.training.epochs = arguments.epochs;
  for (const std::string& name : arguments.models) {
    plan.models.emplace_back(fs::path(name).stem().string(), find_model(name));
  }
  plan.classic = {classic_method("ca", "covariance analysis"),
                  classic_method("multi-scale", "multi-scale surface variation")};
  if (!find_fee().empty()) {
    plan.classic.push_back(
        classic_method("fee", "feature edge estimation", fee_settings(arguments.fee)));
  } else if (!arguments.fee.empty()) {
    throw Error(ErrorKind::kInsufficient, "--fee: the program pcednet-fee was not built");
  }
  for (const std::string& prediction : arguments.predictions) {
    plan.predictions.push_back(named(prediction, "--predictions"));
  }
  return plan;
}

/// The command line as given, without options that do not affect results.
std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string line = "pcednet";
  std::string word;
  std::getline(file, word, '\0');
  while (std::getline(file, word, '\0')) {
    if (word == "--overwrite") continue;
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
      return std::isalnum(c) ||
             std::string_view("-_./=,+:@%{}").find(static_cast<char>(c)) != std::string_view::npos;
    });
    line += plain ? " " + word : fmt::format(" '{}'", word);
  }
  return line;
}

/// Keeps the variants that the user named. Throws Error(kUsage) for an unknown name.
void choose_methods(study::Experiment& experiment, const std::vector<std::string>& wanted) {
  if (wanted.empty()) return;
  std::string known;
  for (const auto& variant : experiment.variants) known += " " + variant.id;
  for (const std::string& id : wanted) {
    const auto& all = experiment.variants;
    if (std::none_of(all.begin(), all.end(), [&](const auto& v) { return v.id == id; })) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("{} has no method {}; there are{}", experiment.name, id, known));
    }
  }
  std::erase_if(experiment.variants, [&](const study::Variant& variant) {
    return std::find(wanted.begin(), wanted.end(), variant.id) == wanted.end();
  });
}

void list_experiments() {
  for (const auto& entry : study::experiments()) {
    std::cout << fmt::format("{:<16} {}\n", entry.name, entry.summary);
  }
}

/// Throws if a seed is there twice: its networks would count twice.
void check_seeds(const std::vector<std::uint64_t>& seeds) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : seeds) {
    if (seen.insert(seed).second) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("--seeds {}: the seed {} is there twice", fmt::join(seeds, ","), seed));
  }
}

/// Throws if an option was given that none of the named experiments reads, only those of `users`
/// do.
void check_is_read(const char* option, const std::vector<std::string>& given,
                   const std::vector<std::string>& names, const std::vector<std::string>& users) {
  if (given.empty() || std::ranges::find_first_of(names, users) != names.end()) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: only the experiment {} reads it", option, fmt::join(users, " or ")));
}

void run_studies(const StudyArguments& arguments, const Common& common) {
  check_seeds(arguments.seeds);
  const auto plan = plan_of(arguments);
  check_is_read("--predictions", arguments.predictions, arguments.names, {"methods"});
  check_is_read("--fee", arguments.fee, arguments.names, {"methods"});
  check_is_read("--models", arguments.models, arguments.names, {"methods", "additions"});
  study::FileOptions file{
      .command = command_line(),
      .energy_is_measured = study::EnergyMeter(arguments.core_watts).has_counters(),
      .watts_per_core = arguments.core_watts};
  const MadeFolder folder(arguments.folder), kept(fs::path(arguments.folder) / "cache");
  std::vector<study::Experiment> experiments;
  for (const std::string& name : arguments.names) {
    experiments.push_back(study::make_experiment(name, plan));
    choose_methods(experiments.back(), arguments.methods);
    study::check_study_file(arguments.folder, name, file.command, common.overwrite());
  }
  const auto any_variant = [&](bool (*is_so)(const study::Variant&)) {
    return std::any_of(experiments.begin(), experiments.end(), [&](const auto& e) {
      return std::any_of(e.variants.begin(), e.variants.end(), is_so);
    });
  };
  const bool tests = any_variant([](const study::Variant& variant) { return !variant.test; });
  const bool trains = any_variant([](const study::Variant& variant) {
    return !variant.training && std::holds_alternative<study::NetworkMethod>(variant.method);
  });
  if (tests && arguments.tests.empty()) {
    throw Error(ErrorKind::kUsage, "study: give labelled clouds to test on: --test NAME=IN");
  }
  const Progress progress = console_progress(common);
  const auto data = read_data(arguments, trains, progress);
  const study::Cache cache(fs::path(arguments.folder) / "cache");
  study::RunOptions run{.watts_per_core = arguments.core_watts};
  run.seeds = !arguments.seeds.empty() ? arguments.seeds
              : arguments.quick        ? std::vector<std::uint64_t>{1}
                                       : std::vector<std::uint64_t>{1, 2, 3};
  if (common.progress != "none") run.on_job = [](const std::string& job) { say(job); };
  for (const study::Experiment& experiment : experiments) {
    const auto result = study::run(experiment, data, cache, run, &progress);
    for (const std::string& note : result.notes) warn(note);
    if (result.results.empty()) {
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("{}: no cloud could be scored, nothing is written", experiment.name));
    }
    study::write_study(arguments.folder, result, file, common.overwrite());
    std::cout << study::to_table(result) << std::flush;
    say(fmt::format(
        "{}: {} networks trained, {} clouds classified; other results were kept\n  -> {}",
        experiment.name, result.trained, result.classified,
        (fs::path(arguments.folder) / (experiment.name + ".json")).string()));
  }
}

void study_command(const StudyArguments& arguments, const Common& common) {
  if (arguments.names == std::vector<std::string>{"list"}) return list_experiments();
  if (arguments.folder.empty()) throw Error(ErrorKind::kUsage, "study: give a folder with -o");
  try {
    run_studies(arguments, common);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kCancelled) throw;
    throw Error(
        ErrorKind::kCancelled,
        fmt::format(
            "stopped by the user; finished results are kept in {}: the same command resumes",
            (fs::path(arguments.folder) / "cache").string()));
  }
}

/// Options of the networks that are trained, where the experiment does not vary them.
void add_network_options(CLI::App& command, StudyArguments& arguments) {
  detect::TrainOptions& training = arguments.networks;
  command.add_option("--classes", training.architecture.classes, "Classes of the networks")
      ->capture_default_str()
      ->check(CLI::IsMember({2, 3}));
  command.add_option("--epochs", arguments.epochs, "Training epochs (0: as in the recipe)")
      ->transform(whole_number(0, 1'000'000));
  command.add_flag("--natural", arguments.natural,
                   "Keep natural class frequencies instead of balancing the classes");
  add_gate_options(command, training.descriptor);
  command.add_flag("--context", training.context, "Train context networks too, like train");
  command.add_option("--distil", training.teachers, "Networks to train first, like train")
      ->transform(whole_number(0, 100));
  add_engine_option(command, training.descriptor);
}

}  // namespace

void add_study(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<StudyArguments>();
  CLI::App* command = add_command(
      app, common, "study", "Run the paper's experiments on your clouds",
      "pcednet study list                                        lists the experiments\n"
      "pcednet study methods --test mine=clouds/ -o study/       on the generated training set\n"
      "pcednet study scales noise --train a/ --test b=b/ --test c=c/ -o study/ --quick\n"
      "pcednet study methods --test c=c/ --predictions other='out/{set}/' -o study/");
  command->add_option("names", arguments->names, "Experiments, or list")->required();
  command->add_option("-o,--output", arguments->folder,
                      "Folder of the study; results kept there are not computed again");
  command->add_option("--train", arguments->training,
                      "Labelled clouds to train on (default: the generated set)");
  command->add_option("--test", arguments->tests,
                      "NAME=IN: labelled clouds to test on; inputs of the same name form one set");
  command->add_option("--positive", arguments->positives,
                      "NAME=sharp or NAME=edge: positive classes of a set (default: edge, that is "
                      "sharp and smooth, if the set has smooth edges)");
  command
      ->add_option("--seeds", arguments->seeds, "Training seeds of every network (default: 1,2,3)")
      ->delimiter(',');
  command->add_flag("--quick", arguments->quick, "One seed, fewer epochs and samples");
  command->add_option("--methods", arguments->methods, "Only these rows of an experiment")
      ->delimiter(',');
  command->add_option("--models", arguments->models, "Trained models to compare: names or files")
      ->delimiter(',');
  command->add_option("--predictions", arguments->predictions,
                      "NAME=DIR: labels of another program; {set} in DIR is the name of the set");
  command->add_option(
      "--fee", arguments->fee,
      "SET=R,r[,THRESHOLD]: radii of feature edge estimation in the unit of the set");
  add_network_options(*command, *arguments);
  command
      ->add_option("--core-watts", arguments->core_watts,
                   "Power of a processor core, for processors without energy counters")
      ->capture_default_str()
      ->check(number_above_0());
  command->callback([arguments, &common] { study_command(*arguments, common); });
}

}  // namespace pcednet::app
