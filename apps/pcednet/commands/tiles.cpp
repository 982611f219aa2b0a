#include "pcednet/tiles/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "byte_size.h"
#include "commands.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/virtual_cloud.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/join.h"
#include "pcednet/tiles/run_tile.h"
#include "pcednet/tiles/tile_file.h"
#include "tile_jobs.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string plan, memory;
  std::vector<std::string> tiles;
  int jobs = 1;
};

/// Adds the numbers of "7" or "0-15".
void add_numbers(const std::string& text, std::size_t tiles, std::set<std::size_t>& numbers) {
  const auto refuse = [&] {
    throw Error(ErrorKind::kUsage, fmt::format("--tile {}: not a tile of 0 to {}, or two with - "
                                               "between them",
                                               text, tiles - 1));
  };
  std::size_t first = 0, last = 0;
  const char* const end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, first);
  if (parsed.ec != std::errc()) refuse();
  last = first;
  if (parsed.ptr != end) {
    if (*parsed.ptr != '-') refuse();
    parsed = std::from_chars(parsed.ptr + 1, end, last);
    if (parsed.ec != std::errc() || parsed.ptr != end) refuse();
  }
  if (last < first || last >= tiles) refuse();
  for (std::size_t id = first; id <= last; ++id) numbers.insert(id);
}

/// The tiles to run, in order.
std::vector<std::size_t> chosen_tiles(const RunArguments& arguments, const tiles::Plan& plan) {
  std::set<std::size_t> chosen;
  for (const std::string& text : arguments.tiles) add_numbers(text, plan.tiles.size(), chosen);
  if (arguments.tiles.empty()) {
    for (std::size_t id = 0; id < plan.tiles.size(); ++id) chosen.insert(chosen.end(), id);
  }
  return {chosen.begin(), chosen.end()};
}

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

using IsDone = std::function<bool(std::size_t tile)>;

/// Runs the tiles that are not done when their turn comes; returns how many.
std::size_t run_here(const tiles::Plan& plan, const std::vector<std::size_t>& ids,
                     const IsDone& is_done, const Common& common) {
  const detect::EdgeModel model = tiles::load_planned_model(plan);
  const Progress progress = console_progress(common);
  std::size_t ran = 0;
  for (const std::size_t id : ids) {
    throw_if_cancelled(&progress);
    if (is_done(id)) continue;
    Stopwatch watch;
    tiles::run_tile(plan, id, model, &progress);
    say(fmt::format("tile {}: {} points, {:.1f} s -> {}", id, plan.tiles[id].points, watch.lap(),
                    plan.tiles[id].output.string()));
    ++ran;
  }
  return ran;
}

std::size_t run_processes(const tiles::Plan& plan, const TileJobs& jobs, const Common& common) {
  tiles::load_planned_model(plan);  // throws before any process starts, as do the next lines
  for (const tiles::PlannedInput& input : plan.inputs) tiles::check_size(input);
  return run_tile_jobs(jobs, console_progress(common));
}

/// Of `all` tiles, of which `begun` were not done at the beginning.
void say_run(std::size_t all, std::size_t begun, std::size_t ran) {
  const auto done = [](std::size_t tiles) {
    return fmt::format("{} {} done", tiles, tiles == 1 ? "was" : "were");
  };
  std::string line = fmt::format("{} tile{} run, {}", ran, ran == 1 ? "" : "s", done(all - begun));
  if (ran < begun) line += fmt::format(", {} by another run meanwhile", done(begun - ran));
  say(line);
}

void run_tiles(const RunArguments& arguments, const Common& common) {
  const tiles::Plan plan = tiles::read_plan(arguments.plan);
  std::vector<std::size_t> ids = chosen_tiles(arguments, plan);
  const std::size_t all = ids.size();
  const IsDone is_done = [&](std::size_t id) {
    return !common.overwrite_files && tiles::state_of(plan, id) == tiles::TileState::kDone;
  };
  std::erase_if(ids, is_done);
  const int jobs = jobs_within(arguments, plan);
  for (const std::size_t id : ids) {
    make_folder(plan.tiles[id].output.parent_path());
    if (!common.overwrite_files) tiles::check_is_tile(plan.tiles[id].output);
  }
  std::size_t ran = 0;
  if (jobs > 1 && ids.size() > 1) {
    ran = run_processes(plan,
                        {.plan = arguments.plan,
                         .tiles = ids,
                         .jobs = jobs,
                         .threads = common.threads,
                         .is_done = is_done},
                        common);
  } else if (!ids.empty()) {
    ran = run_here(plan, ids, is_done, common);
  }
  if (all == 1 && ran == 1) return;  // the tile has reported
  say_run(all, ids.size(), ran);
}

struct StatusArguments {
  std::string plan, json;
  bool verify = false;
};

constexpr std::array<const char*, 3> kStates = {"missing", "damaged", "done"};

struct Group {
  std::vector<std::size_t> ids = {};
  std::size_t points = 0;
};

/// The next command for the plan. Tiles whose damage only digests show are run again only by
/// number.
std::string next_step(const tiles::Plan& plan, const std::array<Group, 3>& groups, bool verify) {
  const std::string path = plan.path.string();
  std::string damaged;
  if (verify) {
    for (const std::size_t id : groups[1].ids) damaged += fmt::format(" --tile {}", id);
  }
  if (!damaged.empty()) {
    const bool more = !groups[0].ids.empty();
    return fmt::format(
        "run {}{} --overwrite{}", path, damaged,
        more ? fmt::format("\n  then: pcednet tiles run {}, for the missing", path) : "");
  }
  const bool done = groups[0].ids.empty() && groups[1].ids.empty();
  if (!done) return "run " + path;
  const fs::path like = plan.tiles.front().output;
  return fmt::format("join {} -o OUT{}", path, like.extension().string());
}

std::string status_text(const tiles::Plan& plan, const std::array<Group, 3>& groups, bool verify) {
  std::string text = fmt::format("{}: {} points in {} tiles\n", plan.path.string(), plan.points(),
                                 plan.tiles.size());
  for (const std::size_t state : {2, 0, 1}) {
    const Group& group = groups[state];
    text += fmt::format("  {:<8} {:>6} tiles, {:>12} points", kStates[state], group.ids.size(),
                        group.points);
    if (state != 2 && !group.ids.empty()) text += ": " + tiles::list_of(group.ids);
    text += "\n";
  }
  return text + "  next: pcednet tiles " + next_step(plan, groups, verify) + "\n";
}

nlohmann::ordered_json status_json(const tiles::Plan& plan, const std::array<Group, 3>& groups) {
  nlohmann::ordered_json json = {{"plan", plan.path.string()},
                                 {"digest", plan.digest},
                                 {"points", plan.points()},
                                 {"tiles", plan.tiles.size()},
                                 {"done_points", groups[2].points}};
  for (const std::size_t state : {2, 0, 1}) json[kStates[state]] = groups[state].ids;
  return json;
}

void show_status(const StatusArguments& arguments, const Common& common) {
  check_not_input(arguments.json, arguments.plan);
  const tiles::Plan plan = tiles::read_plan(arguments.plan);
  const Progress progress = console_progress(common);
  std::array<Group, 3> groups;
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    throw_if_cancelled(&progress);
    Group& group = groups[static_cast<std::size_t>(tiles::state_of(plan, id, arguments.verify))];
    group.ids.push_back(id);
    group.points += plan.tiles[id].points;
  }
  const std::string json = status_json(plan, groups).dump(1) + "\n";
  fmt::print("{}", arguments.json == "-" ? json : status_text(plan, groups, arguments.verify));
  if (!arguments.json.empty() && arguments.json != "-") {
    write_text_file(arguments.json, json, common.overwrite());
  }
}

struct JoinArguments {
  std::string plan, output, vpc;
};

void join_into_file(const tiles::Plan& plan, const std::string& output, const Common& common) {
  const Progress progress = console_progress(common);
  const tiles::Joined joined = tiles::join(plan, output, common.overwrite(), &progress);
  warn_of_losses(output, joined.losses);
  say(fmt::format("{}: {} points of {} tiles", output, joined.points, plan.tiles.size()));
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
  for (const std::string& remark : formats::write_virtual_cloud(vpc, files, common.overwrite())) {
    warn(vpc + ": " + remark);
  }
  say(fmt::format("{}: {} points of {} tiles", vpc, plan.points(), files.size()));
}

void join_tiles(const JoinArguments& arguments, const Common& common) {
  if (arguments.output.empty() && arguments.vpc.empty()) {
    throw Error(ErrorKind::kUsage, "tiles join: needs -o FILE, --vpc FILE or both");
  }
  for (const std::string& file : {arguments.output, arguments.vpc}) {
    check_not_input(file, arguments.plan);
    check_writable(file, common.overwrite());
  }
  const tiles::Plan plan = tiles::read_plan(arguments.plan);
  for (const std::string& file : {arguments.output, arguments.vpc}) {
    tiles::check_not_input(file, plan.inputs);
    for (const tiles::Tile& tile : plan.tiles) check_not_input(file, tile.output);
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
  command->callback([arguments, &common] { run_tiles(*arguments, common); });
}

void add_status(CLI::App& tiles, Common& common) {
  auto arguments = std::make_shared<StatusArguments>();
  CLI::App* command = add_command(tiles, common, "status", "Show which tiles of a plan are done",
                                  "pcednet tiles status city.json\n"
                                  "pcednet tiles status city.json --verify    digests as well\n"
                                  "pcednet tiles status city.json --json -");
  command->add_option("plan", arguments->plan, "The plan")->required();
  command->add_flag("--verify", arguments->verify, "Read every tile and compare its SHA-256");
  command->add_option("--json", arguments->json,
                      "Write the result as JSON to this file; - for standard output only");
  command->callback([arguments, &common] { show_status(*arguments, common); });
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
  add_status(*tiles, common);
  add_join(*tiles, common);
}

}  // namespace pcednet::app
