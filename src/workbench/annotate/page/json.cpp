#include "workbench/annotate/page/json.h"

#include <span>

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

Json json_of(const FileClasses& found) {
  Json list = Json::array();
  for (const auto& [id, name, colour, points] : found.classes) {
    list.push_back({{"id", id}, {"name", name}, {"colour", colour}, {"points", points}});
  }
  return list;
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
  json["file_labels"] = json_of(scene.labels);
  json["file_predicted"] = scene.labels.are_predicted;
  json["las_classes"] = json_of(scene.las_classes);
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
  return {{"run", done.run},
          {"epoch", done.epoch},
          {"epochs", done.epochs},
          {"context", done.is_context},
          {"loss", done.loss}};
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
               {"file_labels", Json::array()},
               {"file_predicted", false},
               {"las_classes", Json::array()},
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

}  // namespace pcednet::annotate
