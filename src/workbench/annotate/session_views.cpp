#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <span>

#include "pcednet/core/error.h"
#include "pcednet/lines/find_lines.h"
#include "workbench/annotate/scene/line_review.h"
#include "workbench/annotate/scene/not_found.h"
#include "workbench/annotate/scene/select.h"
#include "workbench/annotate/session_state.h"

namespace pcednet::annotate {

using Lock = std::unique_lock<std::mutex>;

namespace {

/// The last parts of a path.
std::filesystem::path end_of(const std::filesystem::path& path, std::ptrdiff_t parts) {
  std::filesystem::path end;
  for (auto part = std::prev(path.end(), parts); part != path.end(); ++part) end /= *part;
  return end;
}

/// The name of an input's file, after as many folders as tell it from the other inputs.
std::string name_apart(std::span<const std::filesystem::path> inputs, std::size_t which) {
  const auto& input = inputs[which];
  const auto all = std::distance(input.begin(), input.end());
  for (std::ptrdiff_t parts = 1; parts < all; ++parts) {
    const auto is_alike = [&](const std::filesystem::path& other) {
      return &other != &input && std::distance(other.begin(), other.end()) >= parts &&
             end_of(other, parts) == end_of(input, parts);
    };
    if (std::ranges::none_of(inputs, is_alike)) return end_of(input, parts).string();
  }
  return input.string();
}

}  // namespace

Summary Session::summary(std::size_t cloud) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  if (cloud > s.options.further.size()) throw NotFound(fmt::format("there is no cloud {}", cloud));
  Summary summary = {.name = s.input_of(cloud).stem().string(),
                     .file = s.input_of(cloud).filename().string(),
                     .cloud = cloud,
                     .stage = s.loading.stage,
                     .starts = s.options.starts};
  if (!s.loading.is_done) return summary;
  summary.scene = s.scenes[cloud];
  summary.scales = s.described[cloud]->cloud.scales;
  const auto painted = s.painted_of_each();
  std::vector<std::filesystem::path> inputs;
  for (std::size_t k = 0; k < s.scenes.size(); ++k) inputs.push_back(s.input_of(k));
  for (std::size_t k = 0; k < s.scenes.size(); ++k) {
    summary.clouds.push_back({.file = name_apart(inputs, k),
                              .points = s.scenes[k]->cloud.size(),
                              .painted = painted[k]});
  }
  summary.classes = s.painting->classes();
  if (summary.classes.has_own()) {
    std::erase_if(summary.starts, [&](const std::string& name) { return !s.begins_from(name); });
  }
  summary.counts = counts_of(s.painting->labels().counts(), summary.classes);
  summary.undo = s.painting->labels().undo_steps();
  summary.redo = s.painting->labels().redo_steps();
  summary.settings = s.painting->settings();
  summary.run = s.runs.shown_view();
  summary.is_out_of_date = s.is_out_of_date();
  summary.prediction_version = s.runs.version();
  summary.labels_version = s.labels_version;
  return summary;
}

/// Whether strokes, or steps back, are newer than the shown run.
bool Session::State::is_out_of_date() const {
  const Run* run = runs.shown();
  if (!run) return false;
  if (run->record.number == 0) return painting->labels().painted() > 0;
  return painting->is_painted_after(run->record.records);
}

std::vector<RunView> Session::runs() const {
  const Lock lock(state_->mutex);
  return state_->runs.views();
}

std::vector<std::byte> Session::node_points(std::size_t node, std::size_t cloud) const {
  std::shared_ptr<const Scene> scene;
  {
    const Lock lock(state_->mutex);
    state_->check_cloud(cloud);
    scene = state_->scenes[cloud];
  }
  if (node >= scene->layout.nodes.size()) {
    throw NotFound(fmt::format("there is no node {}", node));
  }
  return encode_points(scene->layout, scene->layout.nodes[node], scene->cloud.positions,
                       scene->prepared.normals, scene->cloud.colours);
}

std::vector<std::uint32_t> Session::State::points_of(const std::vector<std::size_t>& ids,
                                                     std::size_t cloud) const {
  const Layout& layout = scenes[cloud]->layout;
  std::vector<std::uint32_t> points;
  for (const std::size_t id : ids) {
    if (id >= layout.nodes.size() || points.size() > 2 * layout.order.size()) {
      throw NotFound(fmt::format("there is no node {}", id));
    }
    const Node& node = layout.nodes[id];
    const auto first = layout.order.begin() + static_cast<std::ptrdiff_t>(node.first);
    points.insert(points.end(), first, first + static_cast<std::ptrdiff_t>(node.points));
  }
  return points;
}

namespace {

/// Throws NotFound if the input has none.
void check_given(const FileClasses& of) {
  if (of.ids.empty()) throw NotFound("the file has no such classes");
}

/// The class of each of the points. Throws as check_given().
std::vector<std::uint8_t> bytes_at(const FileClasses& of, std::span<const std::uint32_t> points) {
  check_given(of);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(points.size());
  for (const std::uint32_t point : points) bytes.push_back(of.ids[point]);
  return bytes;
}

}  // namespace

Session::Values Session::values(Shown what, const std::vector<std::size_t>& nodes, int feature,
                                int scale, std::size_t cloud) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_cloud(cloud);
  const std::vector<std::uint32_t> points = s.points_of(nodes, cloud);
  if (what == Shown::kFeature) {
    return {feature_bytes(*s.described[cloud], points, feature, scale), 0};
  }
  const Scene& scene = *s.scenes[cloud];
  if (what == Shown::kFileLabels) return {bytes_at(scene.labels, points), 0};
  if (what == Shown::kLasClasses) return {bytes_at(scene.las_classes, points), 0};
  if (what == Shown::kErrors) check_given(scene.labels);
  const auto prediction = s.runs.prediction(cloud);
  const auto labels = s.part(s.painting->labels().classes(), cloud);
  const auto value = [&](std::uint32_t i) -> std::uint8_t {
    if (what == Shown::kLabels) return labels[i];
    const std::uint8_t predicted =
        prediction ? prediction->result.classes[i] : std::uint8_t{kUnlabelled};
    if (what == Shown::kPrediction) return predicted;
    if (what == Shown::kErrors) return error_of(predicted, scene.labels.ids[i]);
    if (!prediction) return 0;
    return byte_of(what == Shown::kPSharp ? prediction->result.p_sharp[i]
                                          : prediction->confidence[i]);
  };
  Values values{.bytes = std::vector<std::uint8_t>(points.size()),
                .version = what == Shown::kLabels ? s.labels_version : s.runs.version()};
  std::transform(points.begin(), points.end(), values.bytes.begin(), value);
  return values;
}

UncertainPlace Session::uncertain(std::size_t after, std::size_t cloud) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_cloud(cloud);
  const auto prediction = s.runs.prediction(cloud);
  if (!prediction) {
    throw Error(ErrorKind::kInsufficient, "there is no prediction yet: paint and train");
  }
  const Scene& scene = *s.scenes[cloud];
  auto& [version, of, places] = s.uncertain;
  if (version != s.runs.version() || of != cloud) {
    of = cloud;
    // Places are as far apart as the view at one of them extends.
    const double apart = std::max(10 * scene.spacing, 0.02 * scene.bounds.diagonal());
    places = rank_uncertain(scene.cloud.positions, scene.selector->tree(), prediction->confidence,
                            apart);
    version = s.runs.version();
  }
  if (after >= places.size()) {
    throw NotFound(fmt::format("there are {} places", places.size()));
  }
  const std::uint32_t point = places[after];
  return {.rank = after + 1,
          .of = places.size(),
          .position = scene.cloud.positions[point] - scene.origin,
          .normal = scene.prepared.normals[point],
          .confidence = prediction->confidence[point],
          .prediction = prediction->result.classes[point]};
}

PointView Session::pick(const Vec3& local_origin, const Vec3& direction, double radius,
                        std::size_t cloud) const {
  const Lock lock(state_->mutex);
  const State& s = *state_;
  s.check_cloud(cloud);
  const Scene& scene = *s.scenes[cloud];
  const auto found =
      annotate::pick(scene.cloud.positions, local_origin + scene.origin, direction, radius);
  if (!found) throw NotFound("no point is near that ray");
  const std::uint32_t point = found->point;
  PointView view{.point = point,
                 .position = scene.cloud.positions[point] - scene.origin,
                 .normal = scene.prepared.normals[point],
                 .label = s.part(s.painting->labels().classes(), cloud)[point],
                 .distance = found->distance};
  if (const auto prediction = s.runs.prediction(cloud)) {
    const float sharp = prediction->result.p_sharp[point];
    const float smooth = prediction->result.p_smooth[point];
    view.prediction = prediction->result.classes[point];
    if (prediction->result.p_class.empty()) {
      view.probabilities = {1.0f - sharp - smooth, smooth, sharp};
    } else {
      view.p_class = prediction->result.p_class[point];
    }
  }
  return view;
}

LinesView Session::lines(std::size_t cloud) const {
  const Lock lock(state_->mutex);
  state_->check_cloud(cloud);
  return {state_->reviews[cloud], cloud, state_->scenes[cloud]};
}

void Session::find_lines(std::size_t cloud, bool boundaries) {
  const Lock lock(state_->mutex);
  State& s = *state_;
  s.check_cloud(cloud);
  if (!s.runs.settled_prediction(cloud)) {
    throw Error(ErrorKind::kInsufficient, "there is no prediction yet: paint and train");
  }
  if (!s.painting->classes().has_edges()) {
    throw Error(ErrorKind::kInsufficient,
                "lines are of edges, which this project's classes are not");
  }
  s.orders.find_lines[cloud] = boundaries;
  s.set_searching(cloud, true);
  s.changed.notify_all();
}

void Session::decide(const LinesDecided& wanted) {
  const Lock lock(state_->mutex);
  state_->check_cloud(wanted.cloud);
  LineReview decided = state_->reviews[wanted.cloud];
  annotate::decide(decided, wanted);
  keep_decisions(decisions_of(state_->options.project, wanted.cloud), decided);
  state_->reviews[wanted.cloud] = std::move(decided);
  state_->emit(wanted);
}

void Session::State::set_searching(std::size_t cloud, bool on) {
  LineReview& review = reviews[cloud];
  if (review.is_searching == on) return;
  review.is_searching = on;
  emit(LinesChanged{.cloud = cloud, .version = review.version, .is_searching = on});
}

void Session::State::find_lines_once(std::size_t cloud, bool boundaries, std::uint64_t mine) {
  std::shared_ptr<const Prediction> prediction;
  int version = 0;
  {
    const Lock lock(mutex);
    prediction = runs.prediction(cloud);
    version = runs.version();
  }
  if (!prediction) return;  // forgotten since it was asked for
  try {
    const Progress reporter = progress(mine);
    const detect::PreparedCloud& prepared = scenes[cloud]->prepared;
    std::vector<std::uint8_t> edges = prediction->result.classes;
    for (std::uint8_t& id : edges) {
      if (id > kBoundary && id != kUnlabelled) id = kNonEdge;
    }
    const auto scanners =
        boundaries ? scanner_of_points(scenes[cloud]->cloud) : std::vector<Vec3>{};
    lines::LineScale scale;
    auto curves = std::make_shared<std::vector<lines::Curve>>(
        lines::find_lines({.positions = prepared.positions,
                           .normals = prepared.normals,
                           .classes = edges,
                           .p_sharp = prediction->result.p_sharp,
                           .p_smooth = prediction->result.p_smooth,
                           .scanners = scanners,
                           .curve = prepared.curve},
                          {.boundaries = boundaries}, &reporter, &scale));
    const Lock lock(mutex);
    if (orders.generation != mine || orders.stopping) return;
    LineReview& review = reviews[cloud];
    const auto kept = decisions_of(options.project, cloud);
    std::error_code ignored;
    if (review.version > 0) std::filesystem::remove(kept, ignored);  // the user begins afresh
    review.decisions = kept_decisions(kept, *curves);
    review.curves = std::move(curves);
    review.tolerance = scale.tolerance;
    review.prediction_version = version;
    ++review.version;
    set_searching(cloud, orders.find_lines.contains(cloud));
  } catch (...) {
    const Lock lock(mutex);
    if (orders.generation == mine) set_searching(cloud, false);
    throw;
  }
}

}  // namespace pcednet::annotate
