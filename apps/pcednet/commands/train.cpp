#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>

#include "batch.h"
#include "commands.h"
#include "models.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/train.h"
#include "prepare.h"
#include "workbench/annotate/learn.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::app {
namespace {

const std::map<std::string, nn::NetworkKind> kNetworks = {{"pcednet", nn::NetworkKind::kPcednet},
                                                          {"fc", nn::NetworkKind::kFc},
                                                          {"cnn", nn::NetworkKind::kCnn}};
const std::map<std::string, nn::Symmetry> kSymmetries = {{"none", nn::Symmetry::kNone},
                                                         {"average", nn::Symmetry::kAverage},
                                                         {"canonical", nn::Symmetry::kCanonical}};
const std::map<std::string, gls::FeatureSet> kFeatureSets = {{"28", gls::FeatureSet::kAll28},
                                                             {"7", gls::FeatureSet::kInvariant7},
                                                             {"6", gls::FeatureSet::kPaper6},
                                                             {"4", gls::FeatureSet::kSpatial4},
                                                             {"3", gls::FeatureSet::kRelief3}};

struct Arguments {
  std::vector<std::string> inputs;
  std::string project, output, network = "pcednet", recipe = "adam", symmetry = "average",
                               features = "6", reconstruction = "sphere";
  int classes = 3, scales = 16, epochs = 0, width = 0, teachers = 0;
  gls::ScaleSpaceOptions descriptor;  ///< its s_min and s_max
  std::optional<double> gate, second_gate;
  double balance = 1.0;
  std::uint64_t seed = 1;
  detect::PrepareOptions preparation;
  bool exact = false, natural = false, context = false;
};

detect::TrainOptions options_of(const Arguments& arguments) {
  detect::TrainOptions options;
  options.descriptor = arguments.descriptor;
  options.descriptor.scales = arguments.scales;
  options.descriptor.features = kFeatureSets.at(arguments.features);
  const auto names = gls::reconstruction_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == arguments.reconstruction) {
      options.descriptor.reconstruction = static_cast<gls::Reconstruction>(i);
    }
  }
  if (arguments.exact) options.descriptor.engine = gls::Engine::kExact;
  options.descriptor.side_gate = arguments.gate;
  options.descriptor.second_gate = arguments.second_gate;
  options.architecture.kind = kNetworks.at(arguments.network);
  options.architecture.classes = arguments.classes;
  options.architecture.width = arguments.width;
  if (arguments.recipe == "paper") options.training = nn::paper_recipe();
  if (arguments.epochs > 0) options.training.epochs = arguments.epochs;
  options.training.balance = arguments.natural ? 0.0 : arguments.balance;
  options.teachers = arguments.teachers;
  options.context = arguments.context;
  options.training.seed = arguments.seed;
  options.symmetry = kSymmetries.at(arguments.symmetry);
  return options;
}

void print_epoch(const nn::EpochReport& report) {
  say(fmt::format("epoch {:>3}  loss {:.4f}  validation loss {:.4f}  accuracy {:.4f}", report.epoch,
                  report.training_loss, report.validation_loss, report.validation_accuracy));
}

/// The model that the annotator saves for a project.
detect::TrainedModel train_project(const Arguments& arguments, const Common& common,
                                   const Progress& progress) {
  const std::filesystem::path file = arguments.project;
  const annotate::Project project = annotate::read_project(file);
  if (arguments.inputs.size() > 1) {
    throw Error(ErrorKind::kUsage, "train: a project is about one input");
  }
  const std::filesystem::path input = arguments.inputs.empty()
                                          ? file.parent_path() / project.input.name
                                          : std::filesystem::path(arguments.inputs.front());
  return annotate::learn_project(
      project, input, [](const std::string& name) { return detect::load_model(find_model(name)); },
      common.progress == "none" ? decltype(&print_epoch)(nullptr) : print_epoch, &progress);
}

detect::TrainedModel train_clouds(const Arguments& arguments, const Common& common,
                                  const Progress& progress) {
  const auto options = options_of(arguments);
  const auto inputs = expand_inputs(arguments.inputs);
  std::vector<io::LoadedCloud> loaded;
  loaded.reserve(inputs.size());  // the training clouds look into them
  std::vector<detect::TrainingCloud> clouds;
  for (const auto& input : inputs) {
    with_name_in_errors(input, [&] {
      loaded.push_back(truth::read_labelled(input));
      throw_if_cancelled(&progress);
    });
    for (const auto& warning : loaded.back().warnings) warn(input.string() + ": " + warning);
    const PointCloud& cloud = loaded.back().cloud;
    clouds.push_back(
        {input.string(), prepare(input, cloud, arguments.preparation, progress), cloud.labels});
  }
  return detect::train(std::filesystem::path(arguments.output).stem().string(), clouds, options,
                       common.progress == "none" ? decltype(&print_epoch)(nullptr) : print_epoch,
                       &progress);
}

void train(const Arguments& arguments, const Common& common) {
  check_writable(arguments.output, common.overwrite());
  if (arguments.inputs.empty() && arguments.project.empty()) {
    throw Error(ErrorKind::kUsage, "train: labelled point files, or --project");
  }
  const Progress progress = console_progress(common);
  const auto trained = arguments.project.empty() ? train_clouds(arguments, common, progress)
                                                 : train_project(arguments, common, progress);
  if (trained.epochs == 0)
    throw Error(ErrorKind::kCancelled, "stopped by the user before an epoch");
  detect::save_model(arguments.output, trained.model, common.overwrite());
  for (const std::string& note : trained.notes) warn(note);
  if (!trained.no_context.empty()) {
    warn(fmt::format("no context network, every point is too sure: {}", trained.no_context));
  }
  const auto& context = trained.model.context;
  say(fmt::format("{} weights{}; seconds: describe {:.2f}, train {:.2f}{}\n  -> {}",
                  trained.model.network.network.parameters.size(),
                  context ? fmt::format(" and {}", context->network.parameters.size()) : "",
                  trained.seconds_describe, trained.seconds_train,
                  context ? fmt::format(", context {:.2f}", trained.seconds_context) : "",
                  arguments.output));
  if (trained.cancelled) {
    throw Error(ErrorKind::kCancelled,
                fmt::format("stopped by the user: {} holds the best of {} epochs", arguments.output,
                            trained.epochs));
  }
}

void add_descriptor_options(CLI::App& command, Arguments& arguments) {
  const auto names = gls::reconstruction_names();
  command.add_option("--scales", arguments.scales, "Scales of the description: 4, 8, ... 128")
      ->capture_default_str();
  command.add_option("--features", arguments.features, "Numbers per scale: 28, 7, 6, 4 or 3")
      ->capture_default_str()
      ->check(CLI::IsMember(kFeatureSets));
  command
      .add_option("--reconstruction", arguments.reconstruction,
                  "The surface that is described at every scale")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
  command.add_flag("--exact", arguments.exact, "Descriptors from exact neighbourhoods (slow)");
  add_scale_range_options(command, arguments.descriptor);
  command.add_option("--gate", arguments.gate,
                     "Side-aware neighbourhoods: leave out points whose normal has a cosine below "
                     "this with the point's own (-1 to 1; default: off)");
  command.add_option("--second-gate", arguments.second_gate,
                     "Describe with another gate too: twice as many numbers per scale");
}

}  // namespace

void add_train(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_command(
      app, common, "train", "Train a network on labelled clouds.",
      "pcednet train painted.ply -o my.safetensors      labels 0, 1, 2; 255 unlabelled\n"
      "pcednet train clouds/ -o my.safetensors --classes 2 --seed 7\n"
      "pcednet train clouds/ -o paper.safetensors --recipe paper\n"
      "pcednet train --project scan_annotation.json -o my.safetensors    as painted in annotate");
  command->add_option("inputs", arguments->inputs, "Labelled point files, or folders of them");
  command->add_option("--project", arguments->project,
                      "Train as the annotator did, on a project that it saved; its input is looked "
                      "for beside it, or given");
  command->add_option("-o,--output", arguments->output, "The model file to write")->required();
  command->add_option("--network", arguments->network, "pcednet, fc or cnn")
      ->capture_default_str()
      ->check(CLI::IsMember(kNetworks));
  command
      ->add_option("--classes", arguments->classes,
                   "3: non-edge, smooth-edge, sharp-edge; 2: sharp-edge and the rest")
      ->capture_default_str()
      ->check(CLI::IsMember({2, 3}));
  add_descriptor_options(*command, *arguments);
  for (const char* of_clouds : {"--s-min", "--s-max"}) {
    command->get_option(of_clouds)->excludes("--project");
  }
  command->add_option("--width", arguments->width, "Neurons per pair of scales (0: as the paper)")
      ->capture_default_str();
  command->add_option("--recipe", arguments->recipe, "adam, or paper (plain SGD as published)")
      ->capture_default_str()
      ->check(CLI::IsMember({"adam", "paper"}));
  command
      ->add_option("--symmetry", arguments->symmetry,
                   "What makes flipped normals change nothing: average, canonical, none")
      ->capture_default_str()
      ->check(CLI::IsMember(kSymmetries));
  command->add_flag(
      "--natural", arguments->natural,
      "Let every class count as often as it occurs, not all alike: fewer false edges");
  command
      ->add_option("--balance", arguments->balance,
                   "1: all classes count alike; 0: as --natural; or between")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0))
      ->excludes("--natural");
  command
      ->add_flag("--context", arguments->context,
                 "Also train a network that looks at the answers around each point and decides "
                 "in the end")
      ->excludes("--project");
  command
      ->add_option("--distil", arguments->teachers,
                   "Train so many networks first and learn from their mean opinion")
      ->check(CLI::Range(0, 100));
  add_prepare_options(*command, arguments->preparation);
  command->add_option("--epochs", arguments->epochs, "Rounds of training (0: the recipe's)");
  command->add_option("--seed", arguments->seed, "Seed of all randomness")->capture_default_str();
  command->callback([arguments, &common] { train(*arguments, common); });
}

}  // namespace pcednet::app
