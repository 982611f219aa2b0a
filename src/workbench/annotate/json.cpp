#include "workbench/annotate/json.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"

namespace pcednet::annotate {
namespace {

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// The number, or null.
template <typename Number>
Json optional_number(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

/// File names may hold any bytes: those that are not UTF-8 are replaced.
std::string dumped(const Json& json) {
  return to_text(json, -1, NotUtf8::kReplace);
}

Json classes_of(const ProjectClasses& classes, const Counts& counts) {
  Json list = Json::array();
  for (std::size_t id = 0; id < counts.size(); ++id) {
    const auto& [name, colour] = classes.table[id];
    list.push_back({{"id", id}, {"name", name}, {"colour", colour}, {"count", counts[id]}});
    if (classes.removed.contains(static_cast<std::uint8_t>(id))) list.back()["removed"] = true;
  }
  return list;
}

Json json_of(const ClassesChanged& changed) {
  return {{"classes", classes_of(changed.classes, changed.counts)},
          {"edges", changed.classes.has_edges()}};
}

Json clouds_of(const Summary& summary) {
  Json clouds = Json::array();
  for (const auto& [file, points, painted] : summary.clouds) {
    clouds.push_back({{"file", file}, {"points", points}, {"painted", painted}});
  }
  return clouds;
}

Json nodes_of(const Scene& scene) {
  Json nodes = Json::array();
  for (std::size_t i = 0; i < scene.layout.nodes.size(); ++i) {
    const Node& node = scene.layout.nodes[i];
    nodes.push_back({{"id", i},
                     {"centre", json_of(node.centre - scene.origin)},
                     {"half", node.half},
                     {"points", node.points},
                     {"children", node.children},
                     {"spacing", node.spacing}});
  }
  return nodes;
}

void describe_scene(const Scene& scene, Json& json) {
  json["points"] = scene.input.points;
  json["origin"] = json_of(scene.origin);
  json["bounds"] = {{"min", json_of(scene.bounds.min - scene.origin)},
                    {"max", json_of(scene.bounds.max - scene.origin)}};
  json["spacing"] = scene.spacing;
  json["has_colours"] = !scene.cloud.colours.empty();
  json["normals"] = scene.prepared.made.empty() ? "file" : "estimated";
  json["nodes"] = nodes_of(scene);
  json["notes"] = notes_of(scene);
}

Json json_of(const HeldOut& held_out) {
  return {{"strokes", held_out.strokes},
          {"accuracy", optional_number(held_out.accuracy)},
          {"start", optional_number(held_out.start)}};
}

Json json_of(const RunView& view) {
  const RunRecord& run = view.record;
  const RunFacts& facts = run.facts;
  return {{"run", run.number},
          {"seconds_train", optional_number(facts.seconds_train)},
          {"seconds_classify", optional_number(facts.seconds_classify)},
          {"loss", optional_number(facts.loss)},
          {"held_out", view.held_out ? json_of(*view.held_out) : Json()},
          {"painted", optional_number(facts.painted)},
          {"start", run.settings.start},
          {"classes", optional_number(facts.classes)},
          {"current", view.is_current},
          {"time", facts.time}};
}

Json json_of(const Painted& painted) {
  return {{"stroke", painted.stroke},
          {"changed", painted.changed},
          {"counts", painted.counts},
          {"painted", painted.painted},
          {"labels_version", painted.labels_version},
          {"nodes", painted.nodes},
          {"undo", painted.undo},
          {"redo", painted.redo},
          {"cloud", painted.cloud}};
}

Json json_of(const FileSaved& saved) {
  return {
      {"path", saved.path}, {"bytes", saved.bytes}, {"strokes_left_out", saved.strokes_left_out}};
}

Json json_of(const StageProgress& progress) {
  return {{"stage", progress.stage}, {"fraction", progress.fraction}};
}

Json json_of(const Ready&) {
  return Json::object();
}

Json json_of(const Problem& problem) {
  return {{"message", problem.message}};
}

Json json_of(const EpochDone& done) {
  return {{"run", done.run}, {"epoch", done.epoch}, {"epochs", done.epochs}, {"loss", done.loss}};
}

Json json_of(const Predicted& predicted) {
  return {{"prediction_version", predicted.prediction_version},
          {"run", predicted.run},
          {"counts", predicted.counts},
          {"out_of_date", predicted.is_out_of_date},
          {"seconds_train", optional_number(predicted.facts.seconds_train)},
          {"seconds_classify", optional_number(predicted.facts.seconds_classify)}};
}

Json json_of(const Judged& judged) {
  return {{"run", judged.run}, {"held_out", json_of(judged.held_out)}};
}

Json json_of(const LinesChanged& changed) {
  return {
      {"cloud", changed.cloud}, {"version", changed.version}, {"searching", changed.is_searching}};
}

Json json_of(const LinesDecided& decided) {
  return {{"cloud", decided.cloud},
          {"version", decided.version},
          {"decision", decision_name(decided.decision)},
          {"lines", decided.lines}};
}

Json json_of(const WriterChanged& changed) {
  return {{"window", changed.window}};
}

struct EventName {
  const char* operator()(const ClassesChanged&) const { return "classes"; }
  const char* operator()(const StageProgress&) const { return "progress"; }
  const char* operator()(const Ready&) const { return "ready"; }
  const char* operator()(const Problem&) const { return "problem"; }
  const char* operator()(const EpochDone&) const { return "training"; }
  const char* operator()(const Painted&) const { return "labels"; }
  const char* operator()(const Predicted&) const { return "prediction"; }
  const char* operator()(const Judged&) const { return "judged"; }
  const char* operator()(const LinesChanged&) const { return "lines"; }
  const char* operator()(const LinesDecided&) const { return "decided"; }
  const char* operator()(const WriterChanged&) const { return "writer"; }
  const char* operator()(const FileSaved&) const { return "saved"; }
};

constexpr std::size_t kMostCentres = 20000, kMostCorners = 20000, kLongestId = 128;

void need(bool good, const char* what) {
  if (!good) throw Error(ErrorKind::kUsage, fmt::format("stroke: {}", what));
}

double number(const Json& value) {
  need(value.is_number(), "a number is missing");
  const double x = value.get<double>();
  need(std::isfinite(x) && std::abs(x) < 1e15, "a number is out of range");
  return x;
}

template <std::size_t N>
std::array<double, N> numbers(const Json& value, const char* what) {
  need(value.is_array() && value.size() == N, what);
  std::array<double, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = number(value[i]);
  return result;
}

Vec3 vector(const Json& value, const char* what) {
  const auto v = numbers<3>(value, what);
  return {v[0], v[1], v[2]};
}

std::uint8_t edge_class(const Json& value) {
  const auto c = value.is_number_integer() ? value.get<std::int64_t>() : -1;
  need((c >= 0 && c < static_cast<std::int64_t>(kMostClasses)) || c == kUnlabelled,
       "a class is 0 to 7, or 255");
  return static_cast<std::uint8_t>(c);
}

std::size_t cloud_in(const Json& json) {
  const auto found = json.find("cloud");
  if (found == json.end()) return 0;
  if (!found->is_number_unsigned()) throw Error(ErrorKind::kUsage, "cloud: a number from 0");
  return found->get<std::size_t>();
}

bool flag(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return false;
  need(found->is_boolean(), "protect and front_only are true or false");
  return found->get<bool>();
}

void read_brush(const Json& json, Stroke& stroke) {
  const Json& centres = json.at("centres");
  need(centres.is_array() && !centres.empty() && centres.size() <= kMostCentres,
       "centres: 1 to 20000 points");
  for (const Json& centre : centres) {
    stroke.centres.push_back(vector(centre, "a centre is [x, y, z]"));
  }
  stroke.radius = number(json.at("radius"));
  need(stroke.radius > 0, "the radius is above 0");
}

void read_polygon(const Json& json, Stroke& stroke) {
  const Json& corners = json.at("polygon");
  need(corners.is_array() && corners.size() >= 3 && corners.size() <= kMostCorners,
       "polygon: 3 to 20000 corners");
  for (const Json& corner : corners) {
    stroke.polygon.push_back(numbers<2>(corner, "a corner is [x, y]"));
  }
  stroke.matrix = numbers<16>(json.at("matrix"), "matrix: 16 numbers");
  stroke.front_only = flag(json, "front_only");
  if (!stroke.front_only) return;
  stroke.point_size = number(json.at("point_size"));
  stroke.viewport = numbers<2>(json.at("viewport"), "viewport: [width, height]");
  need(stroke.point_size > 0 && stroke.point_size <= 1000, "point_size: above 0, at most 1000");
  for (const double side : stroke.viewport) {
    need(side >= 1 && side <= 16384, "viewport: 1 to 16384 pixels a side");
  }
}

Stroke read(const Json& json) {
  need(json.is_object(), "an object is wanted");
  Stroke stroke;
  stroke.id = json.at("id").get<std::string>();
  need(!stroke.id.empty() && stroke.id.size() <= kLongestId, "id: 1 to 128 characters");
  stroke.edge_class = edge_class(json.at("class"));
  stroke.protect = flag(json, "protect");
  stroke.cloud = cloud_in(json);
  if (const auto hidden = json.find("hidden"); hidden != json.end() && !hidden->is_null()) {
    need(hidden->is_array() && hidden->size() <= kMostClasses + 1, "hidden: a list of classes");
    for (const Json& c : *hidden) stroke.hidden.push_back(edge_class(c));
  }
  if (const auto clip = json.find("clip"); clip != json.end() && !clip->is_null()) {
    stroke.clip = BoundingBox{.min = vector(clip->at("min"), "clip.min is [x, y, z]"),
                              .max = vector(clip->at("max"), "clip.max is [x, y, z]")};
  }
  const auto tool = json.at("tool").get<std::string>();
  need(tool == "brush" || tool == "polygon", "tool: brush or polygon");
  if (tool == "brush") {
    read_brush(json, stroke);
  } else {
    stroke.tool = Tool::kPolygon;
    read_polygon(json, stroke);
  }
  return stroke;
}

}  // namespace

std::string to_json(const Summary& summary, Asking window) {
  Json json = {{"name", summary.name},
               {"file", summary.file},
               {"clouds", clouds_of(summary)},
               {"cloud", summary.cloud},
               {"points", 0},
               {"origin", {0, 0, 0}},
               {"bounds", {{"min", {0, 0, 0}}, {"max", {0, 0, 0}}}},
               {"spacing", 0},
               {"has_colours", false},
               {"normals", "file"},
               {"state", summary.scene ? "ready" : "loading"},
               {"stage", summary.stage},
               {"nodes", Json::array()},
               {"features", Json::array()},
               {"classes", classes_of(summary.classes, summary.counts)},
               {"edges", summary.classes.has_edges()},
               {"settings", parse_json(to_line(summary.settings))},
               {"starts", summary.starts},
               {"scales", summary.scales},
               {"strokes", summary.undo},
               {"undo", summary.undo},
               {"redo", summary.redo},
               {"run", summary.run ? json_of(*summary.run) : Json()},
               {"out_of_date", summary.is_out_of_date},
               {"writer", window.is_writer},
               {"known", window.is_open},
               {"prediction_version", summary.prediction_version},
               {"labels_version", summary.labels_version}};
  if (summary.scene) describe_scene(*summary.scene, json);
  for (const auto name : gls::feature_names(gls::ScaleSpaceOptions{}.features)) {
    json["features"].push_back(std::string(name));
  }
  return dumped(json);
}

std::string to_json(std::span<const RunView> runs) {
  Json json = Json::array();
  for (const RunView& run : runs) json.push_back(json_of(run));
  return dumped(json);
}

std::string to_json(const Painted& painted) {
  return dumped(json_of(painted));
}

std::string to_json(const UncertainPlace& place) {
  return dumped({{"rank", place.rank},
                 {"position", json_of(place.position)},
                 {"normal", json_of(place.normal)},
                 {"confidence", place.confidence},
                 {"prediction", place.prediction},
                 {"of", place.of}});
}

std::string to_json(const PointView& point) {
  return dumped({{"point", point.point},
                 {"position", json_of(point.position)},
                 {"normal", json_of(point.normal)},
                 {"label", point.label},
                 {"prediction", point.prediction},
                 {"p", point.probabilities ? Json(*point.probabilities) : Json::array()},
                 {"p_class", optional_number(point.p_class)},
                 {"distance", point.distance}});
}

std::string to_json(const ClassesChanged& changed) {
  return dumped(json_of(changed));
}

std::string to_json(const FileSaved& saved) {
  return dumped(json_of(saved));
}

std::string window_json(const std::string& window, bool is_writer) {
  return dumped({{"window", window}, {"writer", is_writer}});
}

std::string error_json(const std::string& message) {
  return dumped({{"error", message}});
}

std::string event_name(const Event& event) {
  return std::visit(EventName(), event);
}

std::string event_json(const Event& event) {
  return std::visit([](const auto& one) { return dumped(json_of(one)); }, event);
}

Stroke parse_stroke(std::string_view text) {
  try {
    return read(parse_json(text));
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kUsage, fmt::format("stroke: {}", error.what()));
  }
}

std::size_t parse_cloud(std::string_view text) {
  try {
    return cloud_in(parse_json(text));
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kUsage, fmt::format("cloud: {}", error.what()));
  }
}

SaveRequest parse_save(std::string_view text) {
  try {
    const Json json = parse_json(text);
    return {.what = json.at("what").get<std::string>(),
            .name = json.value("name", std::string()),
            .cloud = cloud_in(json),
            .overwrite = json.value("overwrite", false)};
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kUsage, fmt::format("save: {}", error.what()));
  }
}

}  // namespace pcednet::annotate
