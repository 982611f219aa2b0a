#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/core/error.h"
#include "workbench/annotate/not_found.h"
#include "workbench/annotate/places.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {
namespace {

using Json = nlohmann::json;
using Lock = std::unique_lock<std::mutex>;

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json classes_of(const Labels* labels) {
  const auto counts = labels ? labels->counts() : std::array<std::size_t, 3>{};
  return Json::array(
      {{{"id", 0}, {"name", "non-edge"}, {"colour", {255, 255, 255}}, {"count", counts[0]}},
       {{"id", 1}, {"name", "smooth-edge"}, {"colour", {255, 196, 93}}, {"count", counts[1]}},
       {{"id", 2}, {"name", "sharp-edge"}, {"colour", {168, 0, 0}}, {"count", counts[2]}}});
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
  json["spacing"] = scene.spacing();
  json["has_colours"] = !scene.cloud.colours.empty();
  json["normals"] = scene.prepared.made.empty() ? "file" : "estimated";
  json["scales"] = scene.scales;
  json["nodes"] = nodes_of(scene);
}

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f)));
}

}  // namespace

Json Session::State::run_json(std::size_t index) const {
  const RunRecord& run = runs[index].record;
  const RunFacts& facts = run.facts;
  return {{"run", run.number},
          {"seconds_train", optional_number(facts.seconds_train)},
          {"seconds_classify", optional_number(facts.seconds_classify)},
          {"loss", optional_number(facts.loss)},
          {"held_out_accuracy", optional_number(facts.held_out_accuracy)},
          {"painted", optional_number(facts.painted)},
          {"start", run.settings.start},
          {"classes", optional_number(facts.classes)},
          {"current", static_cast<int>(index) == current_run},
          {"time", facts.time}};
}

std::string Session::summary(bool writer) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  Json json = {{"name", s.options.input.stem().string()},
               {"file", s.options.input.filename().string()},
               {"points", 0},
               {"origin", {0, 0, 0}},
               {"bounds", {{"min", {0, 0, 0}}, {"max", {0, 0, 0}}}},
               {"spacing", 0},
               {"has_colours", false},
               {"normals", "file"},
               {"state", s.ready ? "ready" : "loading"},
               {"stage", s.stage},
               {"scales", Json::array()},
               {"nodes", Json::array()}};
  if (s.ready) describe_scene(*s.scene, json);
  Json features = Json::array();
  for (const auto name : gls::feature_names(gls::ScaleSpaceOptions{}.features)) {
    features.push_back(std::string(name));
  }
  json["features"] = features;
  json["classes"] = classes_of(s.labels.get());
  json["settings"] = Json::parse(to_json(s.settings));
  json["strokes"] = s.labels ? s.labels->undo_steps() : 0;
  json["undo"] = s.labels ? s.labels->undo_steps() : 0;
  json["redo"] = s.labels ? s.labels->redo_steps() : 0;
  json["run"] = s.current_run < 0 ? Json() : s.run_json(static_cast<std::size_t>(s.current_run));
  json["writer"] = writer;
  json["prediction_version"] = s.prediction_version;
  json["labels_version"] = s.labels_version;
  return json.dump();
}

std::string Session::runs() const {
  const Lock lock(state_->mutex);
  Json runs = Json::array();
  for (std::size_t i = 0; i < state_->runs.size(); ++i) runs.push_back(state_->run_json(i));
  return runs.dump();
}

std::vector<std::byte> Session::node_points(std::size_t node) const {
  std::shared_ptr<const Scene> scene;
  {
    const Lock lock(state_->mutex);
    state_->check_ready();
    scene = state_->scene;
  }
  if (node >= scene->layout.nodes.size()) {
    throw NotFound(fmt::format("there is no node {}", node));
  }
  return encode_points(scene->layout, scene->layout.nodes[node], scene->cloud.positions,
                       scene->prepared.normals, scene->cloud.colours);
}

Session::Values Session::values(Shown what, const std::vector<std::size_t>& nodes, int feature,
                                int scale) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_ready();
  std::vector<std::uint32_t> points;
  for (const std::size_t id : nodes) {
    if (id >= s.scene->layout.nodes.size() || points.size() > 2 * s.scene->layout.order.size()) {
      throw NotFound(fmt::format("there is no node {}", id));
    }
    const Node& node = s.scene->layout.nodes[id];
    const auto first = s.scene->layout.order.begin() + static_cast<std::ptrdiff_t>(node.first);
    points.insert(points.end(), first, first + static_cast<std::ptrdiff_t>(node.points));
  }
  if (what == Shown::kFeature) return {feature_bytes(*s.described, points, feature, scale), 0};
  const Prediction* prediction = s.prediction();
  const auto value = [&](std::uint32_t i) -> std::uint8_t {
    if (what == Shown::kLabels) return s.labels->classes()[i];
    if (what == Shown::kPrediction) return prediction ? prediction->result.classes[i] : 255;
    if (!prediction) return 0;
    return byte_of(what == Shown::kPSharp ? prediction->result.p_sharp[i]
                                          : prediction->confidence[i]);
  };
  Values values{.bytes = std::vector<std::uint8_t>(points.size()),
                .version = what == Shown::kLabels ? s.labels_version : s.prediction_version};
  std::transform(points.begin(), points.end(), values.bytes.begin(), value);
  return values;
}

std::string Session::uncertain(std::size_t after) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_ready();
  const Prediction* prediction = s.prediction();
  if (!prediction)
    throw Error(ErrorKind::kInsufficient, "there is no prediction yet: paint and train");
  const auto& cloud = s.scene->cloud;
  if (s.uncertain_version != s.prediction_version) {
    // Places are as far apart as a look at one of them reaches.
    const double apart = std::max(10 * s.scene->spacing(), 0.02 * s.scene->bounds.diagonal());
    s.uncertain =
        rank_uncertain(cloud.positions, s.scene->selector->tree(), prediction->confidence, apart);
    s.uncertain_version = s.prediction_version;
  }
  if (after >= s.uncertain.size()) {
    throw NotFound(fmt::format("there are {} places", s.uncertain.size()));
  }
  const std::uint32_t point = s.uncertain[after];
  return Json{{"rank", after + 1},
              {"position", json_of(cloud.positions[point] - s.scene->origin)},
              {"normal", json_of(s.scene->prepared.normals[point])},
              {"confidence", prediction->confidence[point]},
              {"of", s.uncertain.size()}}
      .dump();
}

std::string Session::pick(const Vec3& local_origin, const Vec3& direction, double radius) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_ready();
  const Scene& scene = *s.scene;
  const auto found =
      annotate::pick(scene.cloud.positions, local_origin + scene.origin, direction, radius);
  if (!found) throw NotFound("no point is near that ray");
  const Prediction* prediction = s.prediction();
  Json json = {{"point", found->point},
               {"position", json_of(scene.cloud.positions[found->point] - scene.origin)},
               {"normal", json_of(scene.prepared.normals[found->point])},
               {"label", s.labels->classes()[found->point]},
               {"prediction", 255},
               {"p", Json::array()},
               {"distance", found->distance}};
  if (prediction) {
    const float sharp = prediction->result.p_sharp[found->point];
    const float smooth = prediction->result.p_smooth[found->point];
    json["prediction"] = prediction->result.classes[found->point];
    json["p"] = {1.0f - sharp - smooth, smooth, sharp};
  }
  return json.dump();
}

}  // namespace pcednet::annotate
