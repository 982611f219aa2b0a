#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>

#include "commands.h"
#include "memory_size.h"
#include "models.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/virtual_cloud.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/join.h"
#include "pcednet/tiles/plan.h"
#include "pcednet/tiles/run_tile.h"
#include "pcednet/tiles/tile_file.h"
#include "tile_jobs.h"
#include "tile_numbers.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string plan, memory;
  std::vector<std::string> tiles;
  int jobs = 1;
  bool as_job = false;
};

/// The number of tiles that may run at a time.
int jobs_within(const RunArguments& arguments, const tiles::Plan& plan) {
  if (arguments.memory.empty()) return arguments.jobs;
  const std::uint64_t most = byte_size("--max-memory", arguments.memory);
  if (plan.memory > most) {
    throw Error(ErrorKind::kUsage,
                fmt::format("--max-memory {}: the largest tile takes about {}; plan smaller ones",
                            arguments.memory, size_text(plan.memory)));
  }
  const std::uint64_t fit = std::max<std::uint64_t>(most / plan.memory, 1);
  if (fit >= static_cast<std::uint64_t>(arguments.jobs)) return arguments.jobs;
  say(fmt::format("{} at a time instead of {}: a tile takes up to {}", fit, arguments.jobs,
                  size_text(plan.memory)));
  return static_cast<int>(fit);
}

void say_tile(const tiles::Plan& plan, std::size_t id, double seconds) {
  say(fmt::format("tile {}: {} points, {:.1f} s -> {}", id, plan.tiles[id].points, seconds,
                  plan.tiles[id].output.string()));
}

/// Runs the tiles of the queue; returns how many. A job says nothing: run_tile_jobs() does.
std::size_t run_here(const tiles::Plan& plan, TileQueue& queue, bool as_job, const Common& common) {
  const detect::EdgeModel model = tiles::load_planned_model(plan);
  const Progress progress = console_progress(common), quiet = without_report(&progress);
  const std::size_t all = queue.left();
  std::optional<Stage> stage;
  if (all > 1) stage.emplace(&progress, "tiles", all);  // in place of those of each tile
  std::size_t ran = 0;
  while (const auto id = queue.next()) {
    throw_if_cancelled(&progress);
    Stopwatch watch;
    tiles::run_tile(plan, *id, model, stage ? &quiet : &progress);
    queue.finish(*id);
    if (!as_job) say_tile(plan, *id, watch.lap());
    if (stage) stage->advance();
    ++ran;
  }
  return ran;
}

std::size_t run_processes(const tiles::Plan& plan, TileJobs jobs, TileQueue& queue,
                          const Common& common) {
  tiles::load_planned_model(plan);  // throws before any process starts, as do the next lines
  for (const tiles::PlannedInput& input : plan.inputs) tiles::check_size(input);
  jobs.done = [&](std::size_t tile, double seconds) { say_tile(plan, tile, seconds); };
  return run_tile_jobs(jobs, queue, console_progress(common));
}

/// Of `all` tiles, of which `begun` were not done at the beginning.
void say_run(std::size_t all, std::size_t begun, std::size_t ran) {
  const auto done = [](std::size_t tiles) {
    return fmt::format("{} {} done", tiles, tiles == 1 ? "was" : "were");
  };
  std::string line = fmt::format("{} run, {}", counted(ran, "tile"), done(all - begun));
  if (ran < begun) line += fmt::format(", {} by another run meanwhile", done(begun - ran));
  say(line);
}

/// Tiles that are not run, for a file that may be no tile is in their place.
struct LeftOut {
  std::vector<std::size_t> ids = {};
  fs::path example = {};
};

/// Takes them out of `ids`, and makes the folders of the others.
LeftOut leave_out(const tiles::Plan& plan, std::vector<std::size_t>& ids) {
  LeftOut left;
  std::erase_if(ids, [&](std::size_t id) {
    const fs::path& tile = plan.tiles[id].output;
    make_folder(tile.parent_path());
    const fs::path strange = tiles::strange_file(tile);
    if (strange.empty()) {
      check_writable(tile, Overwrite::kYes);
      return false;
    }
    if (left.ids.empty()) left.example = strange;
    left.ids.push_back(id);
    return true;
  });
  return left;
}

void report_left_out(const LeftOut& left, const RunArguments& arguments) {
  if (left.ids.empty()) return;
  throw Error(
      ErrorKind::kUsage,
      fmt::format("{}: exists, but has no record of being a tile{}: not replaced; to replace "
                  "it: pcednet tiles run {}{} --overwrite",
                  left.example.string(),
                  left.ids.size() == 1
                      ? ""
                      : fmt::format(" ({} such: {})", left.ids.size(), tiles::list_of(left.ids)),
                  shell_word(arguments.plan), tile_options(left.ids)));
}

void run_tiles(const RunArguments& arguments, const Common& common) {
  tiles::Plan plan = tiles::read_plan(arguments.plan);
  find_planned_model(plan.model);
  std::vector<std::size_t> ids = tile_numbers(arguments.tiles, plan.tiles.size());
  std::size_t all = ids.size();
  const auto is_done = [&](std::size_t id) {
    return !common.overwrite_files && tiles::state_of(plan, id) == tiles::TileState::kDone;
  };
  std::erase_if(ids, is_done);
  const int jobs = jobs_within(arguments, plan);
  LeftOut left;
  if (common.overwrite_files) {
    for (const std::size_t id : ids) make_folder(plan.tiles[id].output.parent_path());
  } else {
    left = leave_out(plan, ids);
    all -= left.ids.size();
  }
  std::size_t ran = 0;
  TileQueue queue(plan, ids, is_done);
  if (jobs > 1 && ids.size() > 1) {
    ran = run_processes(
        plan, {.plan = arguments.plan, .jobs = jobs, .threads = common.threads, .done = {}}, queue,
        common);
  } else if (!ids.empty()) {
    ran = run_here(plan, queue, arguments.as_job, common);
  }
  // A single tile has reported, or is left out.
  if (all > 1 || (all == 1 && ran == 0)) say_run(all, ids.size(), ran);
  report_left_out(left, arguments);
}

/// The same for a process of run_tile_jobs(), which tells itself that the user stopped it.
void run_as_job(const RunArguments& arguments, const Common& common) {
  try {
    run_tiles(arguments, common);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kCancelled) throw;
    std::exit(static_cast<int>(ErrorKind::kCancelled));
  }
}

struct JoinArguments {
  std::string plan, output, vpc;
};

void join_into_file(const tiles::Plan& plan, const std::string& output, const Common& common) {
  const Progress progress = console_progress(common);
  const tiles::Joined joined = tiles::join(plan, output, common.overwrite(), &progress);
  warn_of_losses(output, joined.losses);
  say(fmt::format("{}: {} points of {}", output, joined.points,
                  counted(plan.tiles.size(), "tile")));
}

/// Throws if the tiles are PLY, which a virtual point cloud cannot list.
void check_are_las(const tiles::Plan& plan) {
  const fs::path& tile = plan.tiles.front().output;
  if (const auto* format = formats::find_format(tile); format && format->is_las()) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: --vpc lists LAS, LAZ and COPC files; tiles plan --output {{ID}}.laz "
                          "makes the tiles such files",
                          tile.string()));
}

/// Reads only the headers of the tiles.
void list_tiles(const tiles::Plan& plan, const std::string& vpc, const Common& common) {
  check_are_las(plan);
  tiles::check_all_done(plan);
  std::vector<formats::VirtualFile> files;
  for (const tiles::Tile& tile : plan.tiles) files.push_back(formats::virtual_file(tile.output));
  warn_all(vpc, formats::write_virtual_cloud(vpc, files, common.overwrite()));
  say(fmt::format("{}: {} points of {}", vpc, plan.points(), counted(files.size(), "tile")));
}

void join_tiles(const JoinArguments& arguments, const Common& common) {
  if (arguments.output.empty() && arguments.vpc.empty()) {
    throw Error(ErrorKind::kUsage, "tiles join: needs -o FILE, --vpc FILE or both");
  }
  for (const std::string& file : {arguments.output, arguments.vpc}) {
    check_not_input(file, arguments.plan);
    check_writable(file, common.overwrite());
  }
  if (!arguments.output.empty()) tiles::check_joins(arguments.output);
  check_distinct({arguments.output, arguments.vpc});
  const tiles::Plan plan = tiles::read_plan(arguments.plan);
  for (const std::string& file : {arguments.output, arguments.vpc}) {
    tiles::check_not_of_plan(file, plan);
  }
  if (!arguments.vpc.empty()) list_tiles(plan, arguments.vpc, common);
  if (!arguments.output.empty()) join_into_file(plan, arguments.output, common);
}

void add_run(CLI::App& tiles, Common& common) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = add_command(
      tiles, common, "run", "Classify the tiles of a plan that are not done",
      "pcednet tiles run city.json                     all that is missing or damaged\n"
      "pcednet tiles run city.json --jobs 4 --threads 2\n"
      "pcednet tiles run city.json --tile 17           one tile, as a job of a cluster\n"
      "pcednet tiles run city.json --tile 0-99 --overwrite         again");
  command->add_option("plan", arguments->plan, "The plan")->required();
  command->add_option("--tile", arguments->tiles,
                      "Number of a tile, or two with - between them; several times for more");
  command->add_option("--jobs", arguments->jobs, "Tiles at a time, each in its own process")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_option("--max-memory", arguments->memory,
                      "Memory for all jobs together, such as 8G: fewer at a time if needed");
  command->add_flag("--as-job", arguments->as_job)->group("");  // hidden: of run_tile_jobs()
  command->callback(
      [arguments, &common] { (arguments->as_job ? run_as_job : run_tiles)(*arguments, common); });
}

void add_join(CLI::App& tiles, Common& common) {
  auto arguments = std::make_shared<JoinArguments>();
  CLI::App* command =
      add_command(tiles, common, "join", "Write the tiles of a plan into one file, or list them",
                  "pcednet tiles join city.json -o city.laz\n"
                  "pcednet tiles join city.json --vpc city.vpc     a list of the tiles, for QGIS");
  command->add_option("plan", arguments->plan, "The plan")->required();
  command->add_option("-o,--output", arguments->output,
                      "Output file: .laz, .copc.laz, .las or .ply");
  command->add_option("--vpc", arguments->vpc,
                      "Virtual point cloud that lists the tiles, which stay where they are");
  command->callback([arguments, &common] { join_tiles(*arguments, common); });
}

}  // namespace

void add_tiles(CLI::App& app, Common& common) {
  CLI::App* tiles = app.add_subcommand(
      "tiles",
      "Classify clouds beyond memory, tile by tile\n\nExamples:\n"
      "  pcednet tiles plan city/ -o city.json    reads all files once or twice\n"
      "  pcednet tiles run city.json --jobs 4     may be stopped, killed and run again\n"
      "  pcednet tiles status city.json\n"
      "  pcednet tiles join city.json -o city.laz\n");
  tiles->require_subcommand(1);
  add_tiles_plan(*tiles, common);
  add_run(*tiles, common);
  add_tiles_status(*tiles, common);
  add_join(*tiles, common);
}

}  // namespace pcednet::app
