#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "descriptor_options.h"
#include "labelled_files.h"
#include "models.h"
#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/cloud_kind.h"
#include "pcednet/detect/piece.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/detect/train.h"
#include "pcednet/io/text_scan.h"
#include "stage_clock.h"
#include "workbench/annotate/learn/adapt.h"
#include "workbench/annotate/learn/learn.h"
#include "workbench/annotate/project/known_files.h"
#include "workbench/annotate/project/painting.h"

namespace pcednet::app {
namespace {

enum class Recipe { kAdam, kPaper };

struct TrainArguments {
  std::vector<std::string> inputs;
  std::string project, output, las_classification;
  std::string start;  ///< a model file, or the name of a shipped model
  std::vector<std::pair<std::string, std::string>> experts;  ///< model files and kinds of clouds
  std::string pieces;                                        ///< a model file
  std::string only;                                          ///< the kind of clouds to learn from
  bool no_normals = false;                                   ///< ignore the normals of the clouds
  detect::PrepareOptions preparation;
  detect::TrainOptions options;  ///< except those below
  Recipe recipe = Recipe::kAdam;
  int epochs = 0;  ///< 0: the recipe's
  double balance = 1.0;
  bool natural = false;
  bool even_validation = false;
  std::uint64_t seed = 1;
};

detect::TrainOptions options_of(const TrainArguments& arguments) {
  detect::TrainOptions options = arguments.options;
  if (arguments.recipe == Recipe::kPaper) options.training = nn::paper_recipe();
  if (arguments.epochs > 0) options.training.epochs = arguments.epochs;
  options.training.balance = arguments.natural ? 0.0 : arguments.balance;
  options.training.even_validation = arguments.even_validation;
  options.training.seed = arguments.seed;
  return options;
}

void print_epoch(const nn::EpochReport& report) {
  const auto number = [&](double value) {
    return report.is_validated() ? fmt::format("{:.4f}", value) : std::string("-");
  };
  say(fmt::format("epoch {:>3}  loss {:.4f}  validation loss {}  accuracy {}", report.epoch,
                  report.training_loss, number(report.validation_loss),
                  number(report.validation_accuracy)));
}

/// Prints every epoch unless no progress is wanted.
std::function<void(const nn::EpochReport&)> epoch_reports(const Common& common) {
  if (common.progress == "none") return {};
  return print_epoch;
}

detect::CloudKind take_kind(const std::string& option, const std::string& text) {
  if (const auto kind = detect::cloud_kind_of(text)) return *kind;
  throw Error(ErrorKind::kUsage,
              fmt::format("{} {}: write given, estimated, exact, noisy or below=4000, or "
                          "several with commas between them",
                          option, text));
}

struct Experts {
  std::vector<detect::EdgeModel> models = {};
  std::vector<detect::CloudKind> kinds = {};
  std::optional<detect::EdgeModel> pieces = {};
};

/// Throws before the work if they do not fit.
Experts read_experts(const TrainArguments& arguments) {
  Experts experts;
  gls::ScaleSpaceOptions descriptor = arguments.options.descriptor;
  descriptor.range.rounded = true;  // as that of a model always is
  for (const auto& [file, kind] : arguments.experts) {
    experts.models.push_back(detect::load_model(file));
    experts.kinds.push_back(take_kind("--expert", kind));
    const auto classes = static_cast<std::size_t>(arguments.options.architecture.classes);
    detect::check_fits(experts.models.back(), descriptor, classes);
  }
  if (!arguments.pieces.empty()) {
    experts.pieces = detect::load_model(arguments.pieces);
    detect::check_pieces(*experts.pieces, descriptor);
  }
  return experts;
}

void warn_of_cloud(const annotate::ProjectCloud& cloud) {
  warn_all(cloud.file, cloud.loaded.warnings);
  warn_all(cloud.file, cloud.prepared.notes);
  const gls::ScaleRange& range = cloud.described->descriptor.range;
  warn_of_rounding(cloud.file, cloud.loaded.cloud.position_type, cloud.prepared, range,
                   [&] { return detect::smallest_scale(cloud.prepared, range); });
}

/// The model that the annotator saves for a project.
detect::TrainedModel train_project(const TrainArguments& arguments, const Common& common,
                                   const Progress& progress) {
  const std::filesystem::path file = arguments.project;
  if (!std::filesystem::exists(file) && std::filesystem::exists(annotate::journal_of(file))) {
    throw Error(ErrorKind::kUnreadable,
                fmt::format("{}: the project is not saved yet: Save project of the page writes it",
                            file.string()));
  }
  const annotate::Project project = annotate::read_project(file);
  const std::size_t clouds = project.inputs.size();
  const std::vector<std::string>& given = arguments.inputs;
  if (given.size() > clouds) {
    throw Error(ErrorKind::kUsage, clouds == 1
                                       ? "train: a project has one input"
                                       : fmt::format("train: the project has {} inputs", clouds));
  }
  // Missing ones are beside the project, or at their former place relative to the first.
  const std::filesystem::path first = given.empty() ? file : std::filesystem::path(given.front());
  const auto input_of = [&](std::size_t k) -> std::filesystem::path {
    if (k < given.size()) return given[k];
    return annotate::place_of_input(file, project.inputs, k, first.parent_path());
  };
  const auto load_start = [&](const std::string& name) {
    const auto start = annotate::start_file(name, file, shipped_models());
    check_not_input(arguments.output, start);
    return detect::load_model(start);
  };
  return annotate::learn_project(project, {input_of, load_start, warn_of_cloud},
                                 epoch_reports(common), &progress);
}

std::vector<detect::NamedLabels> labels_of(std::span<const LabelledFile> files) {
  std::vector<detect::NamedLabels> labels;
  for (const auto& [path, cloud] : files) labels.push_back({path.string(), cloud.labels});
  return labels;
}

std::vector<detect::NamedLabels> labels_of(std::span<const detect::TrainingCloud> clouds) {
  std::vector<detect::NamedLabels> labels;
  for (const detect::TrainingCloud& cloud : clouds) labels.push_back({cloud.name, cloud.labels});
  return labels;
}

void warn_of_steps(const LabelledFile& file, const detect::PreparedCloud& prepared,
                   const gls::ScaleRange& range) {
  warn_of_rounding(file.path, file.cloud.position_type, prepared, range,
                   [&] { return detect::smallest_scale(prepared, range); });
}

detect::TrainedModel train_clouds(const TrainArguments& arguments, const Experts& experts,
                                  const Common& common, const Progress& progress) {
  auto options = options_of(arguments);
  std::optional<detect::EdgeModel> start;
  if (!arguments.start.empty()) {
    start = detect::load_model(find_model(arguments.start));
    options.descriptor = start->descriptor;
  }
  std::optional<detect::CloudKind> only;
  if (!arguments.only.empty()) only = take_kind("--only", arguments.only);
  // The training clouds refer to the files.
  std::vector<LabelledFile> files =
      read_labelled_files(arguments.inputs, label_codes(arguments.las_classification),
                          arguments.no_normals, options, progress);
  for (const auto& expert : experts.models) detect::check_classes(expert, options.table);
  if (start) {
    annotate::check_classes_of_start(*start, options.table);
    annotate::check_each_is_labelled(labels_of(files), options.table);
  } else if (!only) {
    check_can_learn(labels_of(files), options);
  }
  if (!only) warn_of_memory(files, options, start.has_value());
  std::vector<detect::TrainingCloud> clouds;
  for (LabelledFile& file : files) {
    auto prepared = prepare(file.path, file.cloud, arguments.preparation, progress);
    if (only && !only->has(detect::traits_of(prepared, options.descriptor))) {
      file.cloud = {};
      continue;
    }
    warn_of_steps(file, prepared, options.descriptor.range);
    clouds.push_back({file.path.string(), std::move(prepared), file.cloud.labels});
  }
  if (clouds.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("train: no cloud is of the kind --only {}", arguments.only));
  }
  if (only) check_can_learn(labels_of(clouds), options);
  const std::string name = std::filesystem::path(arguments.output).stem().string();
  const auto on_epoch = epoch_reports(common);
  if (start) {
    return annotate::adapt_clouds(name, *start, clouds, options.table, arguments.seed, on_epoch,
                                  &progress);
  }
  return detect::train(name, clouds, options, on_epoch, &progress);
}

void check_extension(const std::filesystem::path& output) {
  if (io::extension_of(output) == ".safetensors") return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: must end in .safetensors; ONNX is written by the Python package, "
                          "Model.save",
                          output.string()));
}

/// What is worth knowing of a training that is over. `could_start`: also from general.
void tell(const detect::TrainedModel& trained, bool could_start) {
  for (const std::string& note : trained.notes) warn(note);
  if (!trained.no_context.empty()) {
    warn(fmt::format("no context network was trained: the first network left no point in doubt: {}",
                     trained.no_context));
  }
  if (trained.adapted) {
    say("  adapted to the painted points: nothing is held out for validation");
  } else if (!trained.validated) {
    say(
        fmt::format("  nothing was held out for validation, as a class has fewer than 20 points: "
                    "the last epoch was kept{}",
                    could_start ? ". --start general learns more from few points" : ""));
  }
}

void tell_scales(const gls::ScaleRange& range, bool could_start) {
  if (range.s_min > 0 || range.s_max > 0) {
    say("  the model does not keep --s-min and --s-max: give classify the same");
  }
  if (range.s_max > 0 || range.s_max_ratio > 0) return;
  say(
      fmt::format("  its scales grow with the diagonal of a cloud; those {}with --s-max-ratio 8 "
                  "follow the spacing of the points, in pieces and larger clouds as well",
                  could_start ? "of --start general or " : ""));
}

void train(const TrainArguments& arguments, const Common& common) {
  check_not_inputs(arguments.output, arguments.inputs);
  check_not_input(arguments.output, arguments.project);
  for (const auto& [file, kind] : arguments.experts) check_not_input(arguments.output, file);
  check_not_input(arguments.output, arguments.pieces);
  if (!arguments.start.empty()) check_not_input(arguments.output, find_model(arguments.start));
  check_extension(arguments.output);
  check_writable(arguments.output, common.overwrite());
  if (arguments.inputs.empty() && arguments.project.empty()) {
    throw Error(ErrorKind::kUsage, "train: give labelled point files or --project");
  }
  StageClock clock(console_progress(common));
  clock.begin("read");
  const Experts experts = read_experts(arguments);
  auto trained = arguments.project.empty()
                     ? train_clouds(arguments, experts, common, clock.progress())
                     : train_project(arguments, common, clock.progress());
  if (trained.epochs == 0)
    throw Error(ErrorKind::kCancelled, "stopped by the user before the end of the first epoch");
  for (std::size_t i = 0; i < experts.models.size(); ++i) {
    detect::join_expert(trained.model, experts.models[i], experts.kinds[i]);
  }
  if (experts.pieces) detect::join_pieces(trained.model, *experts.pieces);
  detect::save_model(arguments.output, trained.model, common.overwrite());
  const bool could_start = arguments.project.empty() && has_edges(trained.model.table);
  tell(trained, could_start);
  if (arguments.project.empty() && arguments.start.empty()) {
    tell_scales(arguments.options.descriptor.range, could_start);
  }
  const auto& context = trained.model.context;
  say(fmt::format("{} weights{}; seconds: {}\n  -> {}",
                  trained.model.network.network.parameters.size(),
                  context ? fmt::format(" and {}", context->network.parameters.size()) : "",
                  clock.seconds(), arguments.output));
  if (trained.cancelled) {
    throw Error(ErrorKind::kCancelled,
                fmt::format("stopped by the user: {} holds the {} of {} epochs", arguments.output,
                            trained.validated ? "best" : "last", trained.epochs));
  }
}

void add_data_options(CLI::App& command, TrainArguments& arguments) {
  command.add_option("inputs", arguments.inputs, "Labelled point files or folders of them");
  command.add_option("--project", arguments.project,
                     "Repeat a training of the annotator from its project, with its settings; the "
                     "input is expected beside the project unless given");
  command.add_option("--start", arguments.start,
                     "Model that learns the labelled points without unlearning the rest, as in the "
                     "annotator: general, another shipped one or a file. A few strokes suffice");
  command.add_option("-o,--output", arguments.output, "Output model file, .safetensors")
      ->required();
  add_label_codes_option(command, arguments.las_classification);
  add_prepare_options(command, arguments.preparation);
  command.add_flag("--no-normals", arguments.no_normals,
                   "Leave out the clouds' normals: they are estimated, as for clouds without");
  command.add_option(
      "--only", arguments.only,
      "Learn from clouds of this kind alone: given or estimated (normals), exact "
      "(points of a model, without noise) or noisy (both without normals), below=4000 "
      "(points), or several with commas "
      "between them");
  command
      .add_option(
          "--expert", arguments.experts,
          "FILE KIND: a model file, trained with the same options, whose networks decide "
          "for clouds of a kind, written as for --only; where several could, the first does")
      ->type_name("TEXT");
  command
      .add_option("--pieces", arguments.pieces,
                  "A model file, trained on the clouds of `generate pieces` with the same options: "
                  "where it finds a piece of a larger cloud, no expert for few points decides")
      ->needs("--expert");
}

void add_recipe_options(CLI::App& command, TrainArguments& arguments) {
  add_choice(command, "--recipe", arguments.recipe,
             {{"adam", Recipe::kAdam}, {"paper", Recipe::kPaper}},
             "adam, or paper (SGD as published)");
  command.add_option("--epochs", arguments.epochs, "Training epochs (0: as in the recipe)")
      ->transform(whole_number(0, 1'000'000));
  command.add_flag(
      "--natural", arguments.natural,
      "Keep natural class frequencies instead of balancing the classes: fewer false edges");
  command
      .add_option("--balance", arguments.balance,
                  "Balance of the classes, from 0 (natural frequencies) to 1 (equal frequencies)")
      ->capture_default_str()
      ->check(share())
      ->excludes("--natural");
  command.add_flag("--even-validation", arguments.even_validation,
                   "Give every class equal weight when choosing the epoch; without it, classes "
                   "weigh as in training");
  command
      .add_option("--distil", arguments.options.teachers,
                  "Train this many networks first and learn their mean prediction")
      ->transform(whole_number(0, 100));
  command.add_option("--seed", arguments.seed, "Random seed")->capture_default_str();
}

/// Refuses other options than `usable` and those of every training; `why` ends the message.
void check_options(const CLI::App& command, std::vector<std::string_view> usable,
                   std::string_view why) {
  for (const auto* name :
       {"inputs", "--output", "--help", "--threads", "--progress", "--overwrite"}) {
    usable.push_back(name);
  }
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::ranges::count(usable, name) > 0) continue;
    throw Error(ErrorKind::kUsage, fmt::format("train: {} has no effect {}", name, why));
  }
}

}  // namespace

void add_train(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<TrainArguments>();
  CLI::App* command = add_command(
      app, common, "train", "Train a network on labelled clouds",
      "pcednet train painted.ply -o my.safetensors      labels 0, 1, 2; 255 unlabelled\n"
      "pcednet train painted.ply -o my.safetensors --start general    a few strokes suffice\n"
      "pcednet train clouds/ -o my.safetensors --classes 2 --seed 7\n"
      "pcednet train clouds/ -o paper.safetensors --recipe paper\n"
      "pcednet train --project scan_annotation.json -o my.safetensors    a training of annotate");
  add_data_options(*command, *arguments);
  add_descriptor_options(*command, arguments->options.descriptor);
  command
      ->add_flag("--octaves", arguments->options.descriptor.range.octaves,
                 "With --s-max-ratio: describe clouds of uneven spacing at larger scales where "
                 "points are sparser")
      ->needs("--s-max-ratio");
  command
      ->add_flag("--unrounded-scales{false}", arguments->options.descriptor.range.rounded,
                 "With --s-max-ratio: learn at the spacing of each cloud itself, not at the "
                 "preferred number nearest to it, at which clouds are classified")
      ->needs("--s-max-ratio");
  add_network_options(*command, arguments->options);
  add_recipe_options(*command, *arguments);
  command->callback([arguments, command, &common] {
    if (!arguments->project.empty()) {
      check_options(*command, {"--project"}, "on a --project, whose settings hold");
    }
    if (!arguments->start.empty()) {
      check_options(
          *command,
          {"--start", "--seed", "--las-classification", "--keep-orientation", "--no-normals"},
          "beside --start, whose network and training are as they are");
    }
    train(*arguments, common);
  });
}

}  // namespace pcednet::app
