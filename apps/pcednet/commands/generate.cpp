#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "commands.h"
#include "number_options.h"
#include "pcednet/cloud/class_table.h"
#include "pcednet/core/error.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/io/drawing/drawing.h"
#include "workbench/shapes/building.h"
#include "workbench/shapes/sets.h"

namespace pcednet::app {
namespace {

double percent_of(const PointCloud& cloud, EdgeClass label) {
  const auto count = std::count(cloud.labels.begin(), cloud.labels.end(), label);
  return 100.0 * static_cast<double>(count) / static_cast<double>(cloud.size());
}

/// The shares of the edge classes; none of a cloud with own classes.
std::string shares_of(const PointCloud& cloud) {
  if (has_own_classes(classes_of(cloud.comments))) return "";
  return fmt::format(" {:>6.1f} {:>6.1f} {:>6.1f} {:>6.1f}", percent_of(cloud, kSharpEdge),
                     percent_of(cloud, kSmoothEdge), percent_of(cloud, kBoundary),
                     percent_of(cloud, kNonEdge));
}

void write_curves(const std::filesystem::path& path, const std::vector<lines::Curve>& curves,
                  const Common& common) {
  constexpr double kTolerance = 2e-5;
  io::write_drawing(path, curves, {.overwrite = common.overwrite(), .tolerance = kTolerance});
}

/// Makes the clouds and writes each at once.
void run(const std::string& folder, const std::vector<shapes::CloudRecipe>& recipes,
         const Common& common) {
  // Folder inputs leave that of the curves out. It is made for the first of them.
  const std::filesystem::path clouds(folder), curves_folder = clouds / "curves";
  const auto cloud_of = [&](const auto& recipe) { return clouds / (recipe.name + ".ply"); };
  const auto curves_of = [&](const auto& recipe) { return curves_folder / (recipe.name + ".obj"); };
  make_folder(folder);
  const bool has_curves = std::filesystem::exists(curves_folder);
  for (const auto& recipe : recipes) {
    check_writable(cloud_of(recipe), common.overwrite());
    if (has_curves) check_writable(curves_of(recipe), common.overwrite());
  }
  const Progress progress = console_progress(common);
  Stage stage(&progress, "generate", recipes.size());
  say("cloud             points  sharp smooth  bound    non");
  std::size_t points = 0;
  for (const shapes::CloudRecipe& recipe : recipes) {
    const auto [name, cloud, curves] = recipe.make();
    if (!curves.empty()) {
      make_folder(curves_folder.string());
      write_curves(curves_of(recipe), curves, common);
    }
    formats::write_cloud(cloud_of(recipe), cloud, {.overwrite = common.overwrite()});
    say(fmt::format("{:<16} {:>7}{}{}", recipe.name, cloud.size(), shares_of(cloud),
                    recipe.details));
    points += cloud.size();
    stage.advance();
  }
  say(fmt::format("{} clouds, {} points in {}", recipes.size(), points, folder));
}

struct SetArguments {
  std::string folder;
  std::uint64_t seed = 1;
  bool paper_only = false;
  std::vector<double> bands;
  std::string only;
};

/// The options of the set `default`. Throws Error(kUsage).
shapes::DefaultSetOptions default_options(const SetArguments& arguments) {
  shapes::DefaultSetOptions options{.extras = !arguments.paper_only};
  if (const auto& bands = arguments.bands; !bands.empty()) {
    if (bands[0] > bands[1]) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--bands {} {}: the sharp band is wider than the smooth one",
                              bands[0], bands[1]));
    }
    options.bands = {bands[0], bands[1]};
  }
  return options;
}

/// The clouds of the set that are asked for. Throws Error(kUsage) if there is none.
std::vector<shapes::CloudRecipe> recipes_of(const shapes::CloudSet& set,
                                            const SetArguments& arguments) {
  if (set.name == "default") return shapes::default_set(arguments.seed, default_options(arguments));
  std::vector<shapes::CloudRecipe> recipes = set.recipes(arguments.seed);
  std::erase_if(recipes, [&](const shapes::CloudRecipe& recipe) {
    return recipe.name.find(arguments.only) == std::string::npos;
  });
  if (recipes.empty()) {
    throw Error(ErrorKind::kUsage,
                fmt::format("--only {}: no cloud has this in its name", arguments.only));
  }
  return recipes;
}

void add_options(CLI::App& command, const shapes::CloudSet& set, SetArguments& arguments) {
  command
      .add_option(
          "folder", arguments.folder,
          "Folder for the PLY files, created if missing; true curves go to its folder curves")
      ->required();
  command.add_option("--seed", arguments.seed, "Seed of the clouds")->capture_default_str();
  if (set.name == "default") {
    command.add_flag("--paper-only", arguments.paper_only,
                     "Only the nine clouds of the paper, without the further shapes (x_...)");
    command
        .add_option("--bands", arguments.bands,
                    "Widths of the sharp and the smooth band of every cloud, in point spacings")
        ->expected(2)
        ->check(number_above_0());
  } else if (set.name == "lines") {
    command.add_option("--only", arguments.only, "Only the clouds with this in their names");
  }
}

/// A command that writes a folder of clouds.
void add_set(CLI::App& generate, Common& common, const shapes::CloudSet& set) {
  const std::string example = fmt::format("pcednet generate {} clouds/", set.name);
  const std::string option = set.name == "default" ? "--paper-only --seed 2"
                             : set.name == "lines" ? "--only roof_"
                                                   : "--seed 2";
  CLI::App* command = add_command(generate, common, set.name, set.description,
                                  fmt::format("{}\n{} {}", example, example, option));
  auto arguments = std::make_shared<SetArguments>();
  add_options(*command, set, *arguments);
  command->callback(
      [arguments, &set, &common] { run(arguments->folder, recipes_of(set, *arguments), common); });
}

void add_sample(CLI::App& generate, Common& common) {
  auto file = std::make_shared<std::string>();
  auto seed = std::make_shared<std::uint64_t>(1);
  CLI::App* command = add_command(generate, common, "sample",
                                  "The labelled building that the demo classifies, as one file",
                                  "pcednet generate sample building.ply");
  command->add_option("file", *file, "Output file")->required();
  command->add_option("--seed", *seed, "Seed of the points")->capture_default_str();
  command->callback([file, seed, &common] {
    check_writable(*file, common.overwrite());
    const Progress progress = console_progress(common);
    Stage stage(&progress, "generate", 1);
    const shapes::GeneratedCloud made = [&] {
      const EndsAtOnce making;
      return shapes::building_scan(*seed);
    }();
    stage.advance();
    formats::write_cloud(*file, made.cloud,
                         {.overwrite = common.overwrite(), .progress = &progress});
  });
}

}  // namespace

void add_generate(CLI::App& app, Common& common) {
  CLI::App* generate = app.add_subcommand("generate",
                                          "Generate labelled point clouds\n\nExamples:\n"
                                          "  pcednet generate default clouds/\n"
                                          "  pcednet generate default clouds/ --seed 2\n");
  generate->require_subcommand(1);
  for (const shapes::CloudSet& set : shapes::cloud_sets()) add_set(*generate, common, set);
  add_sample(*generate, common);
}

}  // namespace pcednet::app
