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
#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/line_set.h"
#include "workbench/shapes/piece_set.h"
#include "workbench/shapes/relief.h"
#include "workbench/shapes/scan_set.h"
#include "workbench/shapes/terrain.h"
#include "workbench/shapes/varied_set.h"

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

std::string details(const shapes::Recipe& recipe) {
  std::string faults;
  if (recipe.noise > 0.0) faults += fmt::format("  noise {:.2g}", recipe.noise);
  if (recipe.displacement > 0.0) faults += fmt::format("  displaced {}", recipe.displacement);
  if (recipe.unevenness != 1.0) faults += fmt::format("  uneven {}", recipe.unevenness);
  if (recipe.inward) faults += "  inward";
  return faults;
}

std::string details(const shapes::CadRecipe& recipe) {
  return fmt::format("  {}{}{}", recipe.mesh ? "vertices" : "drawn",
                     recipe.estimated ? ", normals estimated" : "",
                     recipe.noise > 0.0 ? fmt::format(", noise {:.2g}", recipe.noise) : "");
}

std::string details(const shapes::ReliefRecipe& recipe) {
  return fmt::format("  {}{}", recipe.even ? "even" : "drawn",
                     recipe.estimated ? ", normals estimated" : "");
}

std::string details(const shapes::ScanRecipe& recipe) {
  return fmt::format("  noise {:.2g}", recipe.scanner.range_noise);
}

std::string details(const shapes::TerrainRecipe& recipe) {
  return fmt::format("  {:.0f} % leaves{}", 100.0 * recipe.leaves,
                     recipe.given_normals ? ", normals given" : "");
}

std::string details(const shapes::LineRecipe&) {
  return "";
}

std::string details(const shapes::PieceRecipe& recipe) {
  return recipe.points == 0 ? "  whole" : "  piece";
}

/// The file of a cloud's true curves: in a separate folder, which folder inputs leave out.
std::filesystem::path curves_of(const std::filesystem::path& folder, const std::string& name) {
  return folder / "curves" / (name + ".obj");
}

void write_curves(const std::filesystem::path& path, const std::vector<lines::Curve>& curves,
                  const Common& common) {
  constexpr double kTolerance = 2e-5;
  io::write_drawing(path, curves, {.overwrite = common.overwrite(), .tolerance = kTolerance});
}

/// Makes the clouds of the recipes, of all lists one after another.
template <typename... Recipes>
void run(const std::string& folder, std::uint64_t seed, const Common& common,
         const std::vector<Recipes>&... lists) {
  make_folder(folder);
  const auto path_of = [&](const auto& recipe) {
    return std::filesystem::path(folder) / (recipe.name + ".ply");
  };
  const auto check = [&](const auto& recipe) {
    check_writable(path_of(recipe), common.overwrite());
  };
  const auto check_curves = [&](const auto& recipe) {
    check_writable(curves_of(folder, recipe.name), common.overwrite());
  };
  (std::for_each(lists.begin(), lists.end(), check), ...);
  make_folder(std::filesystem::path(folder) / "curves");
  (std::for_each(lists.begin(), lists.end(), check_curves), ...);
  const Progress progress = console_progress(common);
  const std::size_t clouds = (lists.size() + ...);
  Stage stage(&progress, "generate", clouds);
  say("cloud             points  sharp smooth  bound    non");
  std::size_t points = 0;
  const auto make = [&](const auto& recipe) {
    const shapes::GeneratedCloud made = shapes::generate(recipe, seed);
    const PointCloud& cloud = made.cloud;
    if (!made.curves.empty()) write_curves(curves_of(folder, recipe.name), made.curves, common);
    formats::write_cloud(path_of(recipe), cloud, {.overwrite = common.overwrite()});
    say(fmt::format("{:<16} {:>7}{}{}", recipe.name, cloud.size(), shares_of(cloud),
                    details(recipe)));
    points += cloud.size();
    stage.advance();
  };
  (std::for_each(lists.begin(), lists.end(), make), ...);
  say(fmt::format("{} clouds, {} points in {}", clouds, points, folder));
}

struct SetArguments {
  std::string folder;
  std::uint64_t seed = 1;
};

/// A command that writes a folder of clouds; its action is set later.
CLI::App* add_open_set(CLI::App& generate, Common& common, SetArguments& arguments,
                       const std::string& name, const std::string& description,
                       const std::string& examples) {
  CLI::App* command = add_command(generate, common, name, description, examples);
  command
      ->add_option(
          "folder", arguments.folder,
          "Folder for the PLY files, created if missing; true curves go to its folder curves")
      ->required();
  command->add_option("--seed", arguments.seed, "Seed of the clouds")->capture_default_str();
  return command;
}

/// A command that writes the clouds of all these recipes for a seed.
template <typename... Recipe>
void add_set(CLI::App& generate, Common& common, const std::string& name,
             const std::string& description, const std::string& examples,
             std::vector<Recipe> (*... recipes)(std::uint64_t seed)) {
  auto set = std::make_shared<SetArguments>();
  add_open_set(generate, common, *set, name, description, examples)->callback([=, &common] {
    run(set->folder, set->seed, common, recipes(set->seed)...);
  });
}

void add_default(CLI::App& generate, Common& common) {
  struct Arguments : SetArguments {
    bool paper_only = false;
    std::vector<double> bands;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_open_set(
      generate, common, *arguments, "default",
      "Labelled clouds for training: a remake of the paper's Default training set, and more",
      "pcednet generate default clouds/\n"
      "pcednet generate default clouds/ --paper-only --seed 2");
  command->add_flag("--paper-only", arguments->paper_only,
                    "Only the nine clouds of the paper, without the further shapes (x_...)");
  command
      ->add_option("--bands", arguments->bands,
                   "Widths of the sharp and the smooth band of every cloud, in point spacings")
      ->expected(2)
      ->check(number_above_0());
  command->callback([arguments, &common] {
    const auto& [folder, seed] = static_cast<const SetArguments&>(*arguments);
    shapes::DefaultSetOptions options{.extras = !arguments->paper_only};
    if (const auto& bands = arguments->bands; !bands.empty()) {
      if (bands[0] > bands[1]) {
        throw Error(ErrorKind::kUsage,
                    fmt::format("--bands {} {}: the sharp band is wider than the smooth one",
                                bands[0], bands[1]));
      }
      options.bands = {bands[0], bands[1]};
    }
    run(folder, seed, common, shapes::default_recipes(seed, options));
  });
}

void add_line_set(CLI::App& generate, Common& common) {
  struct Arguments : SetArguments {
    std::string only;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_open_set(
      generate, common, *arguments, "lines",
      "Clouds with true curves for measuring lines: CAD parts, clean, noisy and scanned, "
      "and roofs",
      "pcednet generate lines parts/\n"
      "pcednet generate lines roofs/ --only roof_");
  command->add_option("--only", arguments->only, "Only the clouds with this in their names");
  command->callback([arguments, &common] {
    std::vector<shapes::LineRecipe> recipes = shapes::line_recipes();
    std::erase_if(recipes, [&](const shapes::LineRecipe& recipe) {
      return recipe.name.find(arguments->only) == std::string::npos;
    });
    if (recipes.empty()) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("--only {}: no cloud has this in its name", arguments->only));
    }
    run(arguments->folder, arguments->seed, common, recipes);
  });
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
  add_default(*generate, common);
  add_set(*generate, common, "cad",
          "Labelled clouds for training: CAD parts, as mesh vertices or surface samples",
          "pcednet generate cad parts/\n"
          "pcednet generate cad parts/ --seed 2",
          shapes::cad_recipes);
  add_set(*generate, common, "worn",
          "Labelled clouds for training: worn parts and reliefs with labelled ridge lines",
          "pcednet generate worn parts/", shapes::worn_recipes, shapes::relief_recipes);
  add_set(*generate, common, "scan",
          "Labelled clouds for training: laser scans of facades, yards, rooms and monuments",
          "pcednet generate scan scans/", shapes::scan_recipes);
  add_set(*generate, common, "varied",
          "Labelled clouds for training: CAD parts from a thousand points on, clean and noisy, "
          "with estimated normals, thinned clouds, and terrains with plants and houses",
          "pcednet generate varied parts/", shapes::varied_part_recipes, shapes::thinned_recipes,
          shapes::terrain_recipes);
  add_set(*generate, common, "sparse",
          "Labelled clouds for training: CAD parts, blocks and roofs of 600 to 5,000 points",
          "pcednet generate sparse parts/", shapes::sparse_part_recipes,
          shapes::sparse_shape_recipes, shapes::sparse_roof_recipes);
  add_set(*generate, common, "drawn",
          "Labelled clouds for training: CAD parts of 6,000 to 40,000 points drawn by area, clean",
          "pcednet generate drawn parts/", shapes::drawn_part_recipes);
  add_set(*generate, common, "pieces",
          "Clouds of 600 to 5,000 points, labelled as whole things or as pieces of scans",
          "pcednet generate pieces clouds/", shapes::piece_recipes);
  add_line_set(*generate, common);
  add_sample(*generate, common);
}

}  // namespace pcednet::app
