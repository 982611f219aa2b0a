#include "workbench/annotate/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/detect/points/thick_noise.h"
#include "pcednet/formats/cloud_facts.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/gls/scales.h"
#include "pcednet/io/ply/faces.h"
#include "pcednet/spatial/curve_order.h"
#include "workbench/annotate/scene/not_found.h"

namespace pcednet::annotate {
namespace {

/// With a ratio, a range begins at the mean of the middle half of the spacings.
constexpr double kAnyRatio = 10.0;

/// Of coordinates that are rounded to more than the spacing.
void add_note_on_float(Scene& scene) {
  if (!detect::may_be_too_coarse(scene.cloud.position_type, scene.prepared.decision, {})) return;
  const double distinct = detect::share_of_places(scene.prepared.positions, scene.prepared.curve);
  const auto note = formats::note_on_float(scene.bounds, scene.spacing, distinct);
  if (!note.empty()) scene.warnings.push_back(note);
}

/// The page describes the points that it shows.
void add_note_on_noise(Scene& scene) {
  if (!scene.prepared.decision.noisy) return;
  const auto noise = detect::find_thick_noise(scene.prepared.positions, scene.prepared.curve);
  if (!noise) return;
  scene.warnings.push_back(text_of(*noise) +
                           ", so few edges are seen here: pcednet classify averages the points");
}

/// The positions; NaN for those that are none, as they are too far out.
std::vector<Vec3> shown_places(const Scene& scene) {
  std::vector<Vec3> places = scene.cloud.positions;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!scene.prepared.positions[i].allFinite()) {
      places[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return places;
}

/// The box of the finite places that are not far from all others.
BoundingBox bounds_of(std::vector<Vec3> places) {
  std::erase_if(places, [](const Vec3& p) { return !p.allFinite(); });
  const BoundingBox most = box_of_most(places);
  std::erase_if(places, [&](const Vec3& p) { return !most.holds(p); });
  return bounding_box(places);
}

}  // namespace

std::shared_ptr<const Scene> load_scene(const std::filesystem::path& input,
                                        const Progress* progress) {
  auto scene = std::make_shared<Scene>();
  Stage stage(progress, "read", 5);
  auto loaded = formats::read_cloud(input);
  stage.advance();
  scene->cloud = std::move(loaded.cloud);
  scene->warnings = std::move(loaded.warnings);
  if (const auto note = io::note_on_faces(scene->cloud); !note.empty()) {
    scene->warnings.push_back(note);
  }
  scene->labels = file_labels(scene->cloud, input);
  scene->las_classes = las_classes(scene->cloud);
  scene->input = {as_utf8(input.filename().string()), digest_of_file(input), scene->cloud.size()};
  with_name_in_errors(input.string(),
                      [&] { scene->prepared = detect::prepare(scene->cloud, {}, progress); });
  const std::vector<Vec3> shown = shown_places(*scene);
  const BoundingBox whole = bounding_box(shown);
  scene->origin = whole.centre();
  scene->bounds = bounds_of(shown);
  stage.advance();
  const Progress quiet = without_report(progress);
  scene->boundary = detect::find_boundary(scene->prepared, &quiet);
  stage.advance();
  const auto curve = spatial::curve_order(scene->cloud.positions);
  const std::vector<Vec3> ordered = spatial::in_order(scene->cloud.positions, curve);
  std::vector<double> spacings = gls::spacings_of_places(scene->cloud.positions, curve);
  const auto range = gls::scale_range(ordered, {}, [&] { return spacings; });
  scene->spacing = gls::scale_range(ordered, {.s_max_ratio = kAnyRatio, .rounded = false}, [&] {
                     return spacings;
                   }).s_min;
  const auto scales = gls::sample_scales(range, gls::ScaleSpaceOptions{}.scales);
  if (const auto note = gls::note_on({}, scales, ordered); !note.empty()) {
    scene->warnings.push_back(note);
  }
  add_note_on_float(*scene);
  add_note_on_noise(*scene);
  stage.advance();
  scene->layout = make_layout(shown, scene->spacing);
  scene->selector = std::make_unique<Selector>(scene->cloud.positions, scene->prepared.normals,
                                               scene->origin, scene->spacing);
  stage.advance();
  return scene;
}

std::vector<std::string> notes_of(const Scene& scene) {
  std::vector<std::string> notes = scene.warnings;
  notes.insert(notes.end(), scene.prepared.notes.begin(), scene.prepared.notes.end());
  return notes;
}

std::shared_ptr<const Prediction> make_prediction(const Scene& scene, detect::EdgeModel model,
                                                  detect::Classification found) {
  auto prediction = std::make_shared<Prediction>();
  prediction->result = std::move(found);
  prediction->model = std::move(model);
  auto& result = prediction->result;
  const bool own = !result.p_class.empty(), edges = has_edges(prediction->model.table);
  if (edges) detect::mark_boundary(scene.boundary, result.classes);
  result.counts = detect::count_classes(result.classes);
  prediction->confidence.resize(result.classes.size());
  for (std::size_t i = 0; i < result.classes.size(); ++i) {
    const float sharp = result.p_sharp[i], smooth = result.p_smooth[i];
    const float non_edge = 1.0f - sharp - smooth;
    const std::uint8_t c = result.classes[i];
    prediction->confidence[i] = edges && c == kBoundary ? 1.0f
                                : own                   ? result.p_class[i]
                                : c == kSharpEdge       ? sharp
                                : c == kSmoothEdge      ? smooth
                                : c == kNonEdge         ? non_edge
                                                        : 0.0f;
  }
  return prediction;
}

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f)));
}

std::vector<std::uint8_t> feature_bytes(const Described& described,
                                        std::span<const std::uint32_t> points, int feature,
                                        int scale) {
  const auto names = gls::column_names(described.descriptor);
  const int features = static_cast<int>(names.size());
  if (feature < 0 || feature >= features || scale < 0 || scale >= described.descriptor.scales) {
    throw NotFound(fmt::format("no feature {} at scale {}", feature, scale));
  }
  const bool is_share = names[static_cast<std::size_t>(feature)].ends_with("phi");
  const auto width = static_cast<std::size_t>(described.descriptor.scales) * names.size();
  const auto column =
      static_cast<std::size_t>(scale) * names.size() + static_cast<std::size_t>(feature);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(points.size());
  for (const std::uint32_t point : points) {
    const std::uint32_t row = described.row_of[point];
    const float x = row == kNoRow ? 0.0f : described.cloud.values[row * width + column];
    const float share = is_share ? x : 0.5f * (1.0f + x / (1.0f + std::abs(x)));
    bytes.push_back(byte_of(share));
  }
  return bytes;
}

}  // namespace pcednet::annotate
