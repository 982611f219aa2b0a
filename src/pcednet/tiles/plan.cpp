#include "pcednet/tiles/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/averages.h"
#include "pcednet/formats/file_name.h"
#include "pcednet/gls/scales.h"
#include "pcednet/io/input_file.h"
#include "pcednet/tiles/sha256.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "pcednet-tiles-2";
constexpr std::array<const char*, 3> kCrowds = {"keep", "merge", "merge by axis"};

/// Converts between paths in plan files and paths in this process.
class Paths {
 public:
  explicit Paths(const fs::path& plan)
      : folder_(fs::absolute(plan).lexically_normal().parent_path()) {}

  /// Throws Error(kUsage) for a path that JSON cannot hold.
  std::string written(const fs::path& path) const {
    const fs::path full = fs::absolute(path).lexically_normal();
    const fs::path relative = full.lexically_relative(folder_);
    const bool is_below = !relative.empty() && *relative.begin() != "..";
    const fs::path& written = is_below ? relative : full;
    formats::check_is_utf8(written);
    return written.string();
  }
  fs::path read(const std::string& text) const { return folder_ / text; }

 private:
  fs::path folder_;
};

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3 vec3_of(const Json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

Json json_of(const std::vector<Vec3>& places) {
  Json list = Json::array();
  for (const Vec3& place : places) list.push_back(place.allFinite() ? json_of(place) : Json());
  return list;
}

std::vector<Vec3> places_in(const Json& j) {
  std::vector<Vec3> places;
  for (const Json& place : j) {
    places.push_back(place.is_null() ? Vec3(Vec3::Constant(NAN)) : vec3_of(place));
  }
  return places;
}

Json json_of(const BoundingBox& box) {
  if (box.empty()) return nullptr;
  return {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()};
}

BoundingBox box_in(const Json& j) {
  if (j.is_null()) return {};
  BoundingBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.min[static_cast<int>(a)] = j.at(a).get<double>();
    box.max[static_cast<int>(a)] = j.at(3 + a).get<double>();
  }
  return box;
}

/// A list with an element on each line, so that a person can read the file.
std::string json_lines(const std::vector<std::string>& elements, const char* indent) {
  std::string text = "[";
  for (const std::string& element : elements) {
    text += fmt::format("{}\n{}{}", text.size() > 1 ? "," : "", indent, element);
  }
  return text + "]";
}

std::string text_of(const PlannedInput& input, const Paths& paths) {
  std::vector<std::string> chunks;
  for (const Chunk& chunk : input.chunks) {
    chunks.push_back(
        to_text(Json{chunk.points, chunk.without_place, json_of(chunk.box), chunk.digest}));
  }
  return fmt::format(
      "{{\"path\":{},\"bytes\":{},\"points\":{},\"narrow_colours\":{},\"scans\":[{},{}],"
      "\"left_out\":{},\"chunks\":{}}}",
      to_text(Json(paths.written(input.path))), input.bytes, input.points(), input.narrow_colours,
      input.first_scan, input.scans, to_text(Json(input.left_out)), json_lines(chunks, "   "));
}

PlannedInput input_of(const Json& j, const Paths& paths) {
  PlannedInput input{.path = paths.read(j.at("path")),
                     .bytes = j.at("bytes"),
                     .narrow_colours = j.at("narrow_colours"),
                     .first_scan = j.at("scans").at(0),
                     .scans = j.at("scans").at(1),
                     .chunks = {},
                     .left_out = j.at("left_out").get<std::vector<std::string>>()};
  for (const Json& chunk : j.at("chunks")) {
    input.chunks.push_back({.points = chunk.at(0),
                            .without_place = chunk.at(1),
                            .box = box_in(chunk.at(2)),
                            .digest = chunk.at(3)});
  }
  return input;
}

std::string text_of(std::size_t id, const Tile& tile, const Plan& plan, const Paths& paths) {
  const double left = plan.grid.edge(tile.column), bottom = plan.grid.edge(tile.row);
  const double length = plan.grid.length();
  // The corners are for readers; column and row decide.
  return fmt::format(
      "{{\"id\":{},\"column\":{},\"row\":{},\"core\":{},\"points\":{},\"output\":{}}}", id,
      tile.column, tile.row, to_text(Json{left, bottom, left + length, bottom + length}),
      tile.points, to_text(Json(paths.written(tile.output))));
}

Json json_of(const PlannedModel& model, const Paths& paths) {
  return {{"name", model.name},       {"path", paths.written(model.path)}, {"sha256", model.sha256},
          {"context", model.context}, {"boundary", model.boundary},        {"exact", model.exact}};
}

PlannedModel model_of(const Json& j, const Paths& paths) {
  return {.name = j.at("name"),
          .path = paths.read(j.at("path")),
          .sha256 = j.at("sha256"),
          .context = j.at("context"),
          .boundary = j.at("boundary"),
          .exact = j.at("exact")};
}

Json normals_of(const Plan& plan) {
  const detect::NormalsDecision& normals = plan.normals;
  const detect::Rounding& rounding = normals.rounding;
  const detect::Averaging& averaging = normals.averaging;
  return {{"made", normals.made},
          {"neighbours", normals.neighbours},
          {"fewest_neighbours", normals.fewest},
          {"noisy", normals.noisy},
          {"exact_planes", normals.exact_planes},
          {"exact", normals.exact},
          {"rounded_to", rounding.step},
          {"rounded_from", json_of(rounding.origin)},
          {"spacing", rounding.spacing},
          {"averaged_noise", averaging.deviation},
          {"averaged_about", json_of(averaging.middle)},
          {"without_poles", normals.poles},
          {"unmarked_estimates", plan.estimates}};
}

detect::NormalsDecision normals_in(const Json& j) {
  return {j.at("made"),
          j.at("neighbours"),
          j.at("fewest_neighbours"),
          j.at("noisy"),
          j.at("exact_planes"),
          j.at("exact"),
          {j.at("rounded_to"), vec3_of(j.at("rounded_from")), j.at("spacing")},
          {j.at("averaged_noise"), vec3_of(j.at("averaged_about"))},
          j.at("without_poles")};
}

Json json_of(const gls::PyramidPlan& pyramid) {
  Json levels = Json::array();
  for (const auto& level : pyramid.levels) {
    levels.push_back({level.merges, kCrowds[static_cast<std::size_t>(level.crowd)]});
  }
  return {{"corner", json_of(pyramid.corner)}, {"side", pyramid.side}, {"levels", levels}};
}

gls::PyramidPlan pyramid_of(const Json& j) {
  gls::PyramidPlan pyramid{.corner = vec3_of(j.at("corner")), .side = j.at("side")};
  for (const Json& level : j.at("levels")) {
    const std::string name = level.at(1);
    const auto found = std::find(kCrowds.begin(), kCrowds.end(), name);
    if (found == kCrowds.end()) throw std::runtime_error("no such crowd");
    pyramid.levels.push_back({level.at(0), static_cast<gls::Crowd>(found - kCrowds.begin())});
  }
  return pyramid;
}

std::string text_of(const Plan& plan, const Paths& paths) {
  std::vector<std::string> inputs, tiles, pyramids;
  for (const auto& pyramid : plan.pyramids) pyramids.push_back(to_text(json_of(pyramid)));
  for (const PlannedInput& input : plan.inputs) inputs.push_back(text_of(input, paths));
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    tiles.push_back(text_of(id, plan.tiles[id], plan, paths));
  }
  const std::vector<std::pair<const char*, std::string>> members = {
      {"format", to_text(Json(kFormat))},
      {"program", to_text(Json(plan.version))},
      {"points", to_text(Json(plan.points()))},
      {"places", to_text(Json(plan.places))},
      {"box", to_text(json_of(plan.box))},
      {"las_steps", to_text(Json(plan.las_steps))},
      {"forms", to_text(Json(plan.forms))},
      {"timed", to_text(Json(plan.timed))},
      {"scanners", to_text(json_of(plan.scanners))},
      {"model", to_text(json_of(plan.model, paths))},
      {"scales", to_text(Json{{"s_min", plan.s_min}, {"s_max", plan.s_max}})},
      {"normals", to_text(normals_of(plan))},
      {"pyramids", json_lines(pyramids, "  ")},
      {"cell", to_text(Json(plan.grid.cell))},
      {"cells_across", to_text(Json(plan.grid.across))},
      {"buffer", to_text(Json(plan.buffer))},
      {"reach", to_text(Json(plan.reach))},
      {"memory", to_text(Json(plan.memory))},
      {"notes", to_text(Json(plan.notes))},
      {"tiles", json_lines(tiles, "  ")},
      {"inputs", json_lines(inputs, "  ")}};
  std::string text;
  for (const auto& [name, value] : members) {
    text += fmt::format("{}\n \"{}\": {}", text.empty() ? "{" : ",", name, value);
  }
  return text + "\n}\n";
}

/// Reads the members of a plan; `member` is then the name of the last one that was looked for.
Plan plan_of(const Json& j, const Paths& paths, std::string& member) {
  const auto at = [&](const char* name) -> const Json& {
    member = name;
    return j.at(name);
  };
  Plan plan;
  plan.version = at("program");
  plan.places = at("places");
  plan.box = box_in(at("box"));
  plan.las_steps = at("las_steps").get<std::vector<double>>();
  plan.forms = at("forms").get<std::vector<std::size_t>>();
  plan.timed = at("timed");
  plan.scanners = places_in(at("scanners"));
  plan.model = model_of(at("model"), paths);
  plan.s_min = at("scales").at("s_min");
  plan.s_max = at("scales").at("s_max");
  plan.normals = normals_in(at("normals"));
  plan.estimates = at("normals").at("unmarked_estimates");
  for (const Json& pyramid : at("pyramids")) plan.pyramids.push_back(pyramid_of(pyramid));
  plan.grid.cell = at("cell");
  plan.grid.across = at("cells_across");
  plan.buffer = at("buffer");
  plan.reach = at("reach");
  plan.memory = at("memory");
  plan.notes = at("notes").get<std::vector<std::string>>();
  for (const Json& input : at("inputs")) plan.inputs.push_back(input_of(input, paths));
  for (const Json& tile : at("tiles")) {
    plan.tiles.push_back(
        {tile.at("column"), tile.at("row"), tile.at("points"), paths.read(tile.at("output"))});
  }
  return plan;
}

/// Whether the scanners of inputs are in the plan's list.
bool are_sound(const std::vector<PlannedInput>& inputs, const Plan& plan) {
  return std::all_of(inputs.begin(), inputs.end(), [&](const PlannedInput& input) {
    return input.first_scan >= 0 && input.scans >= 0 &&
           static_cast<std::size_t>(input.first_scan) + static_cast<std::size_t>(input.scans) <=
               plan.scanners.size();
  });
}

/// Whether a plan may have such pyramids; how many levels there are depends on the model.
bool are_sound(const std::vector<gls::PyramidPlan>& pyramids, const Plan& plan) {
  if (pyramids.empty() || pyramids.size() > gls::kOctaves) return false;
  const double side = (plan.box.max - plan.box.min).maxCoeff();
  const double moved =
      plan.normals.rounding.step + detect::kAveragingReach * plan.normals.averaging.deviation;
  const std::size_t levels = pyramids.front().levels.size();
  return (levels == 0 || !plan.model.exact) &&
         std::all_of(pyramids.begin(), pyramids.end(), [&](const gls::PyramidPlan& pyramid) {
           return pyramid.levels.size() == levels &&
                  (pyramid.corner - plan.box.min).cwiseAbs().maxCoeff() <= moved &&
                  std::abs(pyramid.side - side) <= 2.0 * moved;
         });
}

/// The name of a member with a value that no plan has; empty if all are sound.
std::string unsound_member(const Plan& plan) {
  const auto is_length = [](double v) { return std::isfinite(v) && v >= 0.0; };
  const detect::Averaging& averaging = plan.normals.averaging;
  if (!(std::isfinite(plan.grid.cell) && plan.grid.cell > 0.0)) return "cell";
  if (plan.grid.across < 1) return "cells_across";
  if (!is_length(plan.buffer)) return "buffer";
  if (!is_length(plan.reach)) return "reach";
  if (!(0.0 < plan.s_min && plan.s_min < plan.s_max)) return "scales";
  if (!are_sound(plan.pyramids, plan)) return "pyramids";
  if (plan.normals.neighbours == 1 || plan.normals.neighbours > 10'000) return "normals";
  const bool thins = plan.normals.poles || averaging.deviation > 0.0;
  if (!is_length(averaging.deviation) || (thins && !plan.normals.made)) return "normals";
  if (plan.memory == 0) return "memory";
  if (!plan.las_steps.empty() && plan.las_steps.size() != 6) return "las_steps";
  if (plan.inputs.empty() || !are_sound(plan.inputs, plan)) return "inputs";
  const bool are_inputs =
      std::ranges::all_of(plan.forms, [&](std::size_t form) { return form < plan.inputs.size(); });
  if (plan.forms.empty() || !are_inputs) return "forms";
  if (std::ranges::count(plan.forms, plan.timed) == 0) return "timed";
  if (plan.tiles.empty()) return "tiles";
  return "";
}

/// The plan in a text; throws Error(kUnreadable) or, for another version, Error(kUsage).
Plan parse_plan(const std::string& text, const fs::path& path) {
  const auto refuse = [&](const std::string& why) {
    return Error(ErrorKind::kUnreadable,
                 fmt::format("{}: not a plan of tiles{}", path.string(), why));
  };
  std::string member;
  try {
    const Json j = parse_json(text);
    if (!j.is_object() || !j.contains("format") || j["format"] != kFormat) throw refuse("");
    member = "program";
    const std::string version = j.at(member);
    if (version != kVersion) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("{}: planned by pcednet {}, and this is {}: tiles of both could "
                              "differ. Plan again, or run the other version",
                              path.string(), version, kVersion));
    }
    std::error_code error;
    const fs::path place = fs::canonical(path, error);  // paths are relative to it, not to a link
    Plan plan = plan_of(j, Paths(error ? path : place), member);
    if (const std::string unsound = unsound_member(plan); !unsound.empty()) {
      throw refuse(fmt::format(": \"{}\" is damaged", unsound));
    }
    return plan;
  } catch (const Error&) {
    throw;
  } catch (const Json::parse_error& error) {
    throw refuse(fmt::format(": byte {} is not JSON", error.byte));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    throw refuse(member.empty() ? "" : fmt::format(": \"{}\" is missing or damaged", member));
  }
}

}  // namespace

std::size_t PlannedInput::points() const {
  return std::accumulate(chunks.begin(), chunks.end(), std::size_t{0},
                         [](std::size_t sum, const Chunk& chunk) { return sum + chunk.points; });
}

std::size_t Plan::points() const {
  return std::accumulate(
      inputs.begin(), inputs.end(), std::size_t{0},
      [](std::size_t sum, const PlannedInput& input) { return sum + input.points(); });
}

bool Plan::narrow_colours() const {
  return std::ranges::all_of(inputs, &PlannedInput::narrow_colours);
}

BoundingBox Plan::box_of(const Tile& tile, double around) const {
  BoundingBox found = box;
  const double left = grid.edge(tile.column), bottom = grid.edge(tile.row);
  found.min.x() = left - around, found.max.x() = left + grid.length() + around;
  found.min.y() = bottom - around, found.max.y() = bottom + grid.length() + around;
  return found;
}

void write_plan(const fs::path& path, const Plan& plan, Overwrite overwrite) {
  write_text_file(path, text_of(plan, Paths(path)), overwrite);
}

void check_can_name(const fs::path& plan, std::span<const fs::path> files) {
  const Paths paths(plan);
  for (const fs::path& file : files) paths.written(file);
}

Plan read_plan(const fs::path& path) {
  const std::string text = io::InputFile(path).text();
  Plan plan = parse_plan(text, path);
  plan.path = path;
  plan.digest = Sha256().add(text).hex();
  return plan;
}

}  // namespace pcednet::tiles
