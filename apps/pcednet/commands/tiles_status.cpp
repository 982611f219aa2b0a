#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/join.h"
#include "pcednet/tiles/plan.h"
#include "pcednet/tiles/tile_file.h"
#include "tile_numbers.h"

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

struct StatusArguments {
  std::string plan, json;
  bool verify = false;
};

constexpr std::array<const char*, 3> kStates = {"missing", "damaged", "done"};

struct Group {
  std::vector<std::size_t> ids = {};
  std::size_t points = 0;
};

struct Status {
  std::array<Group, 3> groups = {};       ///< by TileState
  std::vector<std::size_t> strange = {};  ///< of the missing: in their place is another file
  bool verified = false;
  std::vector<Error> changed = {};  ///< inputs, once verified
};

/// The next command for the plan. Tiles whose damage only digests show are run again only by
/// number, as are those whose place another file takes.
std::string next_step(const tiles::Plan& plan, const Status& status) {
  const std::string path = shell_word(plan.path.string());
  const auto& missing = status.groups[0].ids;
  const auto& damaged = status.groups[1].ids;
  std::vector<std::size_t> again = status.strange;
  if (status.verified) again.insert(again.end(), damaged.begin(), damaged.end());
  std::sort(again.begin(), again.end());
  if (!again.empty()) {
    const bool more = missing.size() + damaged.size() > again.size();
    return fmt::format(
        "run {}{} --overwrite{}", path, tile_options(again),
        more ? fmt::format("\n  then: pcednet tiles run {}, for the others", path) : "");
  }
  if (!missing.empty() || !damaged.empty()) return "run " + path;
  const fs::path like = plan.tiles.front().output;
  return fmt::format("join {} -o OUT{}", path, like.extension().string());
}

std::string status_text(const tiles::Plan& plan, const Status& status) {
  std::string text = fmt::format("{}: {} points in {}\n", plan.path.string(), plan.points(),
                                 counted(plan.tiles.size(), "tile"));
  for (const std::size_t state : {2, 0, 1}) {
    const Group& group = status.groups[state];
    text += fmt::format("  {:<8} {:>6} tiles, {:>12} points", kStates[state], group.ids.size(),
                        group.points);
    if (state != 2 && !group.ids.empty()) text += ": " + tiles::list_of(group.ids);
    text += "\n";
  }
  if (!status.strange.empty()) {
    text +=
        fmt::format("  of the missing, in the place of {}: files without the record of a tile\n",
                    tiles::list_of(status.strange));
  }
  return text + "  next: pcednet tiles " + next_step(plan, status) + "\n";
}

OrderedJson status_json(const tiles::Plan& plan, const Status& status) {
  OrderedJson json = {{"plan", plan.path.string()},
                      {"digest", plan.digest},
                      {"points", plan.points()},
                      {"tiles", plan.tiles.size()},
                      {"done_points", status.groups[2].points}};
  for (const std::size_t state : {2, 0, 1}) json[kStates[state]] = status.groups[state].ids;
  json["in_the_way"] = status.strange;
  return json;
}

/// Reads all inputs again.
std::vector<Error> changed_inputs(const tiles::Plan& plan, const Progress& progress) {
  std::vector<Error> changed;
  for (const tiles::PlannedInput& input : plan.inputs) {
    try {
      tiles::for_each_chunk(
          input, [](const tiles::Chunk&) { return true; }, &progress,
          [](const PointCloud&, std::size_t) {});
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::kCancelled) throw;
      changed.push_back(error);
    }
  }
  return changed;
}

Status find_status(const tiles::Plan& plan, bool verify, const Progress& progress) {
  Status status{.verified = verify};
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    throw_if_cancelled(&progress);
    const tiles::TileState state = tiles::state_of(plan, id, verify);
    Group& group = status.groups[static_cast<std::size_t>(state)];
    group.ids.push_back(id);
    group.points += plan.tiles[id].points;
    const bool is_missing = state == tiles::TileState::kMissing;
    if (is_missing && !tiles::strange_file(plan.tiles[id].output).empty()) {
      status.strange.push_back(id);
    }
  }
  if (verify) status.changed = changed_inputs(plan, progress);
  return status;
}

/// Throws for the inputs that have changed since the plan, if any have.
void report_changed(const std::vector<Error>& changed) {
  if (changed.empty()) return;
  for (std::size_t i = 1; i < changed.size(); ++i) say_error(changed[i].what());
  throw changed.front();
}

void show_status(const StatusArguments& arguments, const Common& common) {
  check_not_input(arguments.json, arguments.plan);
  if (arguments.json != "-") check_writable(arguments.json, common.overwrite());
  const tiles::Plan plan = tiles::read_plan(arguments.plan);
  tiles::check_not_of_plan(arguments.json, plan);
  const Status status = find_status(plan, arguments.verify, console_progress(common));
  const std::string json = to_text(status_json(plan, status), 1, NotUtf8::kReplace) + "\n";
  fmt::print("{}", arguments.json == "-" ? json : status_text(plan, status));
  if (!arguments.json.empty() && arguments.json != "-") {
    write_text_file(arguments.json, json, common.overwrite());
  }
  report_changed(status.changed);
}

}  // namespace

void add_tiles_status(CLI::App& tiles, Common& common) {
  auto arguments = std::make_shared<StatusArguments>();
  CLI::App* command = add_command(tiles, common, "status", "Show which tiles of a plan are done",
                                  "pcednet tiles status city.json\n"
                                  "pcednet tiles status city.json --verify    digests as well\n"
                                  "pcednet tiles status city.json --json -");
  command->add_option("plan", arguments->plan, "The plan")->required();
  command->add_flag("--verify", arguments->verify,
                    "Read every tile and every input, and compare digests");
  command->add_option("--json", arguments->json,
                      "Write the result as JSON to this file; - for standard output only");
  command->callback([arguments, &common] { show_status(*arguments, common); });
}

}  // namespace pcednet::app
