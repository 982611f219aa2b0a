#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "batch.h"
#include "classify_cloud.h"
#include "commands.h"
#include "descriptor_options.h"
#include "memory_size.h"
#include "models.h"
#include "number_options.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/make_plan.h"
#include "pcednet/tiles/plan.h"
#include "pcednet/tiles/tile_file.h"
#include "result_plan.h"
#include "tile_numbers.h"
#include "view_options.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct PlanArguments {
  std::vector<std::string> inputs;
  std::string plan, folder, output, sorted, memory = "2G";
  double tile_length = 0.0;
  ModelArguments model{.name = kDefaultModel};
  detect::PrepareOptions preparation;
  std::vector<double> viewpoint;
};

/// The default folder of the tiles: beside the plan.
fs::path folder_of(const PlanArguments& arguments) {
  if (!arguments.folder.empty()) return arguments.folder;
  const fs::path plan = arguments.plan;
  return plan.parent_path() / (plan.stem().string() + "_tiles");
}

/// Throws unless the name of the plan is that of a file.
void check_plan_name(const PlanArguments& arguments) {
  if (arguments.plan != "-") return;
  throw Error(ErrorKind::kUsage,
              "-o -: a plan is a file, beside which its tiles are; give a name such as plan.json");
}

/// Throws before the inputs are read if the plan could not name a file.
void check_names(const fs::path& plan, const tiles::PlanRequest& request) {
  std::vector<fs::path> files = request.inputs;
  files.insert(files.end(), {request.model.path, request.folder / request.output});
  if (!request.sort.folder.empty()) files.push_back(request.sort.folder);
  tiles::check_can_name(plan, files);
}

/// Warns where the folder of the tiles holds some of an earlier plan.
void warn_of_old_tiles(const PlanArguments& arguments) {
  const std::string digest = tiles::read_plan(arguments.plan).digest;
  const fs::path folder = folder_of(arguments);
  const fs::path old = tiles::tile_of_another_plan(folder, digest);
  if (old.empty()) return;
  warn(
      fmt::format("{}: tiles of another plan are here, such as {}: tiles run replaces those with "
                  "names of this plan, and others stay",
                  folder.string(), old.filename().string()));
}

void plan_tiles(const PlanArguments& arguments, const Common& common) {
  check_plan_name(arguments);
  check_not_inputs(arguments.plan, arguments.inputs);
  check_not_input(arguments.plan, model_file(arguments.model));
  check_writable(arguments.plan, common.overwrite());
  const ModelArguments& model = arguments.model;
  tiles::PlanRequest request{.inputs = without_results(expand_inputs(arguments.inputs)),
                             .folder = folder_of(arguments),
                             .output = arguments.output,
                             .model = planned_model(model),
                             .tile_length = arguments.tile_length,
                             .memory = byte_size("--max-memory", arguments.memory),
                             .keep_orientation = arguments.preparation.keep_orientation,
                             .viewpoint = place_in(arguments.viewpoint),
                             .sort = {.folder = arguments.sorted, .overwrite = common.overwrite()},
                             .sort_name = "--sort FOLDER"};
  check_names(arguments.plan, request);
  const Progress progress = console_progress(common);
  const detect::EdgeModel loaded = load_model(model);
  if (has_own_classes(loaded.table)) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: has own classes ({}); tiles are for models of "
                                               "edges, classify takes it",
                                               model.name, pcednet::names_of(loaded.table)));
  }
  tiles::Plan plan;
  with_name_in_errors(arguments.inputs.size() == 1 ? arguments.inputs.front() : arguments.plan,
                      [&] { plan = tiles::make_plan(request, loaded, &progress); });
  check_scales(arguments.inputs.front(), plan.box, loaded.descriptor);
  tiles::write_plan(arguments.plan, plan, common.overwrite());
  for (const std::string& note : plan.notes) warn(note);
  warn_of_old_tiles(arguments);
  warn_of_replaced(arguments.inputs.front(), detect::replaced_attributes(tiles::outline_of(plan)));
  say(fmt::format("{}: {} points in {} of length {:g}, buffer {:.4g}", arguments.plan,
                  plan.points(), counted(plan.tiles.size(), "tile"), plan.grid.length(),
                  plan.buffer));
  say(fmt::format("  scales: {:.9g} to {:.9g}", plan.s_min, plan.s_max));
  say(fmt::format("  the largest tile takes about {} of memory", size_text(plan.memory)));
  if (plan.memory > request.memory) {
    warn(fmt::format("that is more than --max-memory {}: {}", arguments.memory,
                     arguments.tile_length > 0.0 ? "--tile is that long"
                                                 : "no tile is shorter than its buffer"));
  }
  say(fmt::format("  next: pcednet tiles run {}", shell_word(arguments.plan)));
}

}  // namespace

void add_tiles_plan(CLI::App& tiles, Common& common) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = add_command(
      tiles, common, "plan", "Decide how to classify point files tile by tile",
      "pcednet tiles plan city/ -o city.json\n"
      "pcednet tiles plan city/ -o city.json --max-memory 1G       memory of one tile\n"
      "pcednet tiles plan a.laz b.laz -o ab.json --tile 250 --output {XLEFT}_{YBOTTOM}.laz");
  command
      ->add_option("inputs", arguments->inputs,
                   "LAS, LAZ, COPC and binary PLY files, folders of them, or a "
                   ".vpc that names some")
      ->required();
  command->add_option("-o", arguments->plan, "The plan, a JSON file")->required();
  command
      ->add_option("--tile", arguments->tile_length,
                   "Length of a tile, in the unit of the points (default: the largest for the "
                   "memory)")
      ->check(length_above_0());
  command
      ->add_option("--max-memory", arguments->memory,
                   "Memory that one tile may take, such as 500M or 2G")
      ->capture_default_str();
  command->add_option("--out-dir", arguments->folder,
                      "Folder for the tiles (default: <plan>_tiles beside the plan)");
  command->add_option("--output", arguments->output,
                      "Names of the tiles, with {ID}, {COLUMN}, {ROW}, {XLEFT}, {XRIGHT}, "
                      "{YBOTTOM}, {YTOP} (default: {ID}.laz, or {ID}.ply for PLY)");
  command->add_option(
      "--sort", arguments->sorted,
      "Folder for copies of the inputs with their points in order in space: a tile reads "
      "little beyond its buffer of these");
  add_model_options(*command, arguments->model);
  add_prepare_options(*command, arguments->preparation);
  add_viewpoint_option(*command, arguments->viewpoint);
  command->callback([arguments, &common] { plan_tiles(*arguments, common); });
}

}  // namespace pcednet::app
