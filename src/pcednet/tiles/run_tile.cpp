#include "pcednet/tiles/run_tile.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/formats/parts.h"
#include "pcednet/gls/scales.h"
#include "pcednet/io/parts.h"
#include "pcednet/tiles/forms.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/sha256.h"
#include "pcednet/tiles/sort_inputs.h"
#include "pcednet/tiles/tile_file.h"

namespace pcednet::tiles {
namespace {

/// The points of a part in the core of a tile, and those around it.
struct Chosen {
  std::vector<std::uint32_t> core, around;
};

Chosen choose(const PointCloud& part, const Plan& plan, std::size_t tile, const BoundingBox& box) {
  const Tile& wanted = plan.tiles[tile];
  Chosen chosen;
  for (std::uint32_t i = 0; i < part.size(); ++i) {
    const Vec3& position = part.positions[i];
    if (!has_place(position)) {
      if (tile == 0) chosen.core.push_back(i);
    } else if (plan.grid.core_of(position) == std::array{wanted.column, wanted.row}) {
      chosen.core.push_back(i);
    } else if (box.holds(position)) {
      chosen.around.push_back(i);
    }
  }
  return chosen;
}

void add_core(const PointCloud& core, PointCloud& all) {
  const std::vector<Vec3> places = places_of(core.positions);
  all.positions.insert(all.positions.begin(), places.begin(), places.end());
  all.normals.insert(all.normals.begin(), core.normals.begin(), core.normals.end());
  all.scanners = core.scanners;
  if (const Attribute* scans = find_attribute(core, "scan")) {
    if (all.attributes.empty())
      all.attributes = {{scans->name, scans->type, scans->components, {}}};
    std::vector<std::byte>& bytes = all.attributes.front().bytes;
    bytes.insert(bytes.begin(), scans->bytes.begin(), scans->bytes.end());
  }
  detect::set_estimated_normals(all, detect::declares_estimated_normals(core));
}

/// All points of `prepared` that decide in the core. The core's own come first, unless averages
/// stand for them.
detect::PartOfCloud part_of(const Plan& plan, std::size_t tile, std::size_t core,
                            const PointCloud& all, const detect::PreparedCloud& prepared) {
  detect::PartOfCloud part{.pyramids = plan.pyramids, .points = plan.places, .wanted = {}};
  const double averaging = detect::kAveragingReach * plan.normals.averaging.deviation;
  const BoundingBox near = plan.box_of(plan.tiles[tile], plan.reach + averaging);
  const std::span<const Vec3> positions =
      prepared.is_averaged() ? prepared.positions : std::span<const Vec3>(all.positions);
  part.wanted.assign(positions.size(), 1);
  for (std::size_t i = prepared.is_averaged() ? 0 : core; i < positions.size(); ++i) {
    part.wanted[i] = near.holds(positions[i]) ? 1 : 0;
  }
  for (std::size_t i = 0; i < core && prepared.is_averaged(); ++i) {
    const std::uint32_t its = prepared.average_of[i];
    if (its != detect::kNoAverage) part.wanted[its] = 1;
  }
  return part;
}

void keep_first(std::size_t points, TileFindings& findings) {
  if (!findings.made.empty()) findings.made.resize(points);
  detect::Classification& found = findings.found;
  found.classes.resize(points);
  found.p_sharp.resize(points);
  found.p_smooth.resize(points);
  found.p_class.resize(std::min(points, found.p_class.size()));
  found.counts = detect::count_classes(found.classes);
}

/// Throws where the decisions on voxels are not those that the model needs.
void check_pyramids(const Plan& plan, const gls::ScaleSpaceOptions& descriptor) {
  const bool has_levels = !plan.model.exact && gls::fits_spheres(descriptor.reconstruction);
  const std::size_t levels = has_levels ? static_cast<std::size_t>(descriptor.scales) : 0;
  if (plan.pyramids.size() == gls::octave_count(descriptor.range) &&
      plan.pyramids.front().levels.size() == levels) {
    return;
  }
  throw Error(ErrorKind::kUnreadable,
              fmt::format("{}: not a plan of tiles: \"pyramids\" does not fit the model",
                          plan.path.string()));
}

/// Takes the numbers from sort_inputs(), if present; otherwise those of the reading order.
void take_numbers(TileCloud& points) {
  const Attribute* column = find_attribute(points.core, kNumberColumn);
  if (!column) return;
  for (std::size_t i = 0; i < points.numbers.size(); ++i) {
    points.numbers[i] = static_cast<std::uint64_t>(column->value(i));
  }
  erase_attribute(points.core, kNumberColumn);
}

}  // namespace

TileFindings classify_tile(const Plan& plan, std::size_t tile, const detect::EdgeModel* model,
                           TileCloud& points, const Progress* progress) {
  const bool own_classes = model && has_own_classes(model->table);
  TileFindings findings{.found = detect::nothing_found(points.core.size(), own_classes)};
  if (std::any_of(points.all.positions.begin(), points.all.positions.end(), has_place)) {
    auto prepared = detect::prepare(points.all, {.decided = plan.normals}, progress);
    const auto part = part_of(plan, tile, points.core.size(), points.all, prepared);
    prepared.part = &part;
    if (model) findings.found = detect::classify(prepared, *model, progress);
    if (model && plan.model.boundary && has_edges(model->table)) {
      detect::mark_boundary(prepared, findings.found, progress);
    }
    if (model) findings.found = of_all_points(prepared, std::move(findings.found));
    findings.made = of_all_points(prepared, std::move(prepared.made));
  }
  keep_first(points.core.size(), findings);
  points.all = {};
  return findings;
}

TileCloud read_tile(const Plan& plan, std::size_t tile, const Progress* progress) {
  const BoundingBox box = plan.box_of(plan.tiles[tile], plan.buffer);
  TileCloud points{.core = outline_of(plan), .all = {}, .numbers = {}};
  std::size_t before = 0;
  for (const PlannedInput& input : plan.inputs) {
    const auto is_wanted = [&](const Chunk& chunk) {
      return box.meets(chunk.box) || (tile == 0 && chunk.without_place > 0);
    };
    for_each_chunk(input, is_wanted, progress, [&](PointCloud& part, std::size_t first) {
      take_columns(points.core, part);
      const Chosen chosen = choose(part, plan, tile, box);
      append_points(part, chosen.core, points.core);
      append_surface(part, chosen.around, points.all);
      for (const std::uint32_t i : chosen.core) points.numbers.push_back(before + first + i);
    });
    before += input.points();
  }
  take_numbers(points);
  add_core(points.core, points.all);
  if (points.core.size() == plan.tiles[tile].points) return points;
  throw Error(ErrorKind::kFailure,
              fmt::format("tile {}: {} points instead of the {} that were planned", tile,
                          points.core.size(), plan.tiles[tile].points));
}

detect::EdgeModel load_planned_model(const Plan& plan) {
  if (sha256_of_file(plan.model.path) != plan.model.sha256) {
    throw Error(ErrorKind::kModelMismatch,
                fmt::format("{}: not the model that the tiles were planned with",
                            plan.model.path.string()));
  }
  detect::EdgeModel model = detect::load_model(plan.model.path);
  if (!plan.model.context) detect::drop_context(model);
  model.descriptor.range.s_min = plan.s_min;
  model.descriptor.range.s_max = plan.s_max;
  model.descriptor.engine = plan.model.exact ? gls::Engine::kExact : gls::Engine::kFast;
  check_pyramids(plan, model.descriptor);
  return model;
}

void run_tile(const Plan& plan, std::size_t tile, const detect::EdgeModel& model,
              const Progress* progress) {
  const std::filesystem::path& path = plan.tiles[tile].output;
  TileCloud points = read_tile(plan, tile, progress);
  const TileFindings findings = classify_tile(plan, tile, &model, points, progress);
  detect::add_result(points.core, findings.made, findings.found, model);
  io::PartOutline outline = io::outline_of(points.core);
  outline.is_las = !plan.las_steps.empty();
  TileRecord record{.plan = plan.digest, .tile = tile, .points = points.core.size()};
  write_claim(path, record);
  try {
    const auto writer = formats::create_parts(
        path, outline, {.overwrite = Overwrite::kYes, .new_normals = findings.made.empty()});
    writer->append(points.core);
    writer->commit();
  } catch (...) {
    remove_claim(path);
    throw;
  }
  record.counts = findings.found.counts;
  write_record(path, record);
}

}  // namespace pcednet::tiles
