#include "pcednet/tiles/make_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pcednet/core/error.h"
#include "pcednet/core/version.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/context.h"
#include "pcednet/detect/piece.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/formats/cloud_facts.h"
#include "pcednet/gls/scales.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/tiles/agreement.h"
#include "pcednet/tiles/dense_sample.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/las_steps.h"
#include "pcednet/tiles/layout.h"
#include "pcednet/tiles/sample.h"
#include "pcednet/tiles/sha256.h"
#include "pcednet/tiles/sort_inputs.h"

namespace pcednet::tiles {
namespace {

/// Up to this many points the plan is exact: it makes the decisions of the whole cloud in memory.
constexpr std::size_t kSampled = 2'000'000;

/// The distance to the k-th nearest other, from the mean distance to the 10 nearest: some
/// sqrt(k / 10) on a surface, where the tenth is at 1.5 times the mean.
double reach_of(std::size_t neighbours, double mean_distance) {
  return 1.5 * mean_distance * std::sqrt(static_cast<double>(neighbours) / 10.0);
}

/// The sign of a normal depends on its connections within this many mean distances.
constexpr double kSignReach = 64.0;

/// Whether a level of the pyramid merges crowds.
bool is_crowded(const Plan& plan) {
  return std::any_of(plan.pyramids.begin(), plan.pyramids.end(), [](const auto& pyramid) {
    return std::any_of(pyramid.levels.begin(), pyramid.levels.end(),
                       [](const auto& level) { return level.crowd != gls::Crowd::kKeep; });
  });
}

/// The parts of cubes whose averages do not depend on points beyond them.
std::vector<BoundingBox> inner_parts(std::vector<BoundingBox> cubes,
                                     const detect::Averaging& averaging) {
  const Vec3 margin = Vec3::Constant(2.0 * detect::kAveragingReach * averaging.deviation);
  for (BoundingBox& cube : cubes) cube = {cube.min + margin, cube.max - margin};
  return cubes;
}

/// The spacing of the points as they are described, and all points counted: `sample` is of all, and
/// `prepared` what is described of the dense one.
Spacing measure(const SampledPoints& sample, const DenseSample& dense,
                const PreparedSample& prepared, const Plan& plan, const gls::ScaleRange& given,
                CellCounts& counts, const Progress* progress) {
  const detect::NormalsDecision& normals = plan.normals;
  const bool averaged = normals.averaging.deviation > 0.0;
  const bool thinned = averaged || (normals.poles && sample.is_all);
  if (sample.is_all) {
    counts.add(sample.positions);
    counts.add_without_place(plan.points() - sample.positions.size());
  } else if (averaged) {
    stream_points(plan, "count", progress, [&](auto positions) { counts.add(positions); });
  }
  if (!thinned) return find_spacing(sample, plan, given, counts, progress);
  const std::vector<Vec3> described = spatial::in_order(prepared.positions, prepared.curve);
  const std::vector<BoundingBox> inner = inner_parts(dense.cubes, normals.averaging);
  return find_spacing({described, true, inner}, plan, given, counts, progress);
}

/// Sets the distance around a core within which points affect the points in it.
void set_buffer(const detect::EdgeModel& model, const Spacing& spacing, Plan& plan) {
  // Voxels measure an eps of the scale; where a level merges crowds, blocks of 8 cells do.
  const double cells = model.descriptor.eps * plan.s_max * (is_crowded(plan) ? 10.0 : 2.0);
  const bool moves = gls::projects(model.descriptor.reconstruction);
  const double described = plan.s_max * (moves ? 2.0 : 1.0) + cells;
  const std::size_t fitted = std::max(plan.normals.neighbours, normals::kExactNeighbours);
  const double normals =
      plan.normals.made ? reach_of(fitted, spacing.wide) + kSignReach * spacing.median : 0.0;
  const double boundary =
      plan.model.boundary
          ? 2.0 * reach_of(detect::kBoundaryNeighbours, spacing.wide) +
                detect::kBoundaryRounds * reach_of(detect::kBoundaryNeighbours, spacing.median)
          : 0.0;
  plan.reach = plan.model.context && model.context
                   ? reach_of(static_cast<std::size_t>(detect::kContextSizes.back()), spacing.wide)
                   : 0.0;
  const double averages = 2.0 * detect::kAveragingReach * plan.normals.averaging.deviation;
  plan.buffer = std::max(plan.reach + described, boundary) + normals + averages;
}

/// How often the average point is read, if each tile reads the chunks that it meets.
double times_read(const Plan& plan) {
  const auto cores = [&](double from, double to) {
    const auto core = [&](double at) {
      return plan.grid.core_of_cell(static_cast<std::int64_t>(std::floor(at / plan.grid.cell)));
    };
    return static_cast<double>(core(to + plan.buffer) - core(from - plan.buffer) + 1);
  };
  double sum = 0.0;
  for (const PlannedInput& input : plan.inputs) {
    for (const Chunk& chunk : input.chunks) {
      if (chunk.box.empty()) continue;
      const double tiles =
          cores(chunk.box.min.x(), chunk.box.max.x()) * cores(chunk.box.min.y(), chunk.box.max.y());
      sum += static_cast<double>(chunk.points) *
             std::min(tiles, static_cast<double>(plan.tiles.size()));
    }
  }
  return sum / static_cast<double>(plan.points());
}

/// Whether nearly every tile would read everything.
bool is_too_often(double times, const Plan& plan) {
  constexpr double kMostTimes = 8.0, kFewPoints = 5e7;
  return times > kMostTimes && times * static_cast<double>(plan.points()) > kFewPoints;
}

/// `about` is "about " where the numbers are estimates.
[[noreturn]] void refuse_order(const PlanRequest& request, std::string_view about, double tiles,
                               double times) {
  const std::string& name = request.sort_name;
  throw Error(
      ErrorKind::kUsage,
      fmt::format("the points of the inputs are in no order in space: {}{:.0f} tiles would "
                  "read each point {}{:.0f} times: choose longer tiles, or sort the inputs{}",
                  about, tiles, about, times,
                  name.empty() ? "" : fmt::format(": {} makes copies in order", name)));
}

std::size_t count_tiles(std::span<const Vec3> sample, double length) {
  CellCounts tiles(length);
  tiles.add(sample);
  return tiles.cells().size();
}

/// The least number of tiles.
double least_tiles(const PlanRequest& request, const Plan& plan, std::span<const Vec3> sample) {
  if (request.tile_length > 0.0) {
    return static_cast<double>(count_tiles(sample, request.tile_length));
  }
  const std::uint64_t fixed = memory_for(0, {}), for_points = memory_for(plan.points(), {}) - fixed;
  return static_cast<double>(for_points) /
         static_cast<double>(std::max(request.memory, fixed + 1) - fixed);
}

/// Throws before the second reading if the inputs would be rejected after it.
void check_order_early(const PlanRequest& request, const Plan& plan, std::span<const Vec3> sample) {
  if (!request.sort.folder.empty()) return;
  const auto points = static_cast<double>(plan.points());
  const double tiles = least_tiles(request, plan, sample);
  double sum = 0.0;
  for (const PlannedInput& input : plan.inputs) {
    for (const Chunk& chunk : input.chunks) {
      const Vec3 shares = shares_of(chunk.box, plan.box);
      sum += static_cast<double>(chunk.points) * (shares.x() * shares.y());
    }
  }
  const double times = tiles * sum / points;
  if (!is_too_often(times, plan)) return;
  constexpr double kMegabyte = 1e6;
  const std::uint64_t least = memory_for(kChunkPoints, {});
  if (request.tile_length == 0.0 && request.memory < least) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{:.3g} MB of memory are less than one tile needs: {:.0f} MB and more",
                            static_cast<double>(request.memory) / kMegabyte,
                            static_cast<double>(least) / kMegabyte));
  }
  // Points that are not in the sample may be in further tiles, and buffers are not known yet.
  refuse_order(request, "about ", tiles, times);
}

/// Throws if a file is there twice.
void check_inputs_differ(const PlanRequest& request) {
  std::map<std::filesystem::path, std::filesystem::path> seen;
  for (const auto& path : request.inputs) {
    std::error_code error;
    const auto [first, is_new] = seen.emplace(std::filesystem::canonical(path, error), path);
    if (is_new || error) continue;
    throw Error(ErrorKind::kUsage, fmt::format("{}: the same file as the input {}", path.string(),
                                               first->second.string()));
  }
}

/// How often the average point of copies in order would be read, about: of chunks at the buffer's
/// edge, taken for squares, two thirds of the side are beyond it (measured on 9 and 16 tiles).
double times_read_in_order(const CellCounts& counts, const Plan& plan) {
  const auto points = static_cast<double>(plan.points());
  const double chunks = points / static_cast<double>(kChunkPoints * plan.tiles.size());
  const double beyond = 2.0 / 3.0 * plan.grid.length() / std::sqrt(std::max(chunks, 1.0));
  return static_cast<double>(points_with_buffers(counts, plan.grid, plan.buffer + beyond)) / points;
}

/// Notes how often the tiles read each point, if that is often and copies in order would help.
void note_reading(const PlanRequest& request, double times, const CellCounts& counts, Plan& plan) {
  constexpr double kMostTimes = 3.0, kLeastGain = 1.5;
  if (times <= kMostTimes) return;
  const double in_order = times_read_in_order(counts, plan);
  if (times <= kLeastGain * in_order) return;
  const std::string& name = request.sort_name;
  plan.notes.push_back(
      fmt::format("neighbours in space are far apart in the inputs: the {} tiles will read each "
                  "point {:.1f} times, but about {:.1f} times from copies in order{}",
                  plan.tiles.size(), times, in_order,
                  name.empty() ? "" : fmt::format(", which {} makes", name)));
}

/// Copies the inputs if the request says so; otherwise throws for inputs that need it.
void settle_order(const PlanRequest& request, const CellCounts& counts, Plan& plan,
                  const Progress* progress) {
  const double times = times_read(plan);
  const bool in_order = !is_too_often(times, plan);
  if (request.sort.folder.empty()) {
    if (!in_order) refuse_order(request, "", static_cast<double>(plan.tiles.size()), times);
    note_reading(request, times, counts, plan);
  } else if (!in_order || !request.sort.if_needed) {
    sort_inputs(request.sort, plan, progress);
  }
}

/// Notes inputs that hold the same points as another.
void note_copies(Plan& plan) {
  std::map<std::vector<std::string>, const PlannedInput*> seen;
  for (const PlannedInput& input : plan.inputs) {
    std::vector<std::string> digests;
    for (const Chunk& chunk : input.chunks) digests.push_back(chunk.digest);
    const auto [first, is_new] = seen.emplace(std::move(digests), &input);
    if (is_new) continue;
    plan.notes.push_back(fmt::format("{}: holds the same points as {}: they count twice",
                                     input.path.string(), first->second->path.string()));
  }
}

/// The inputs of the plan, and a sample of their points.
Sample index_inputs(const PlanRequest& request, Plan& plan, const Progress* progress) {
  Sample sample(kSampled);
  std::vector<IndexedInput> indexed;
  for (const auto& path : request.inputs) {
    indexed.push_back(index_input(path, progress, plan.notes,
                                  [&](const PointCloud& part) { sample.add(part.positions); }));
    for (const Chunk& chunk : indexed.back().input.chunks) plan.box.add(chunk.box);
    if (indexed.back().input.points() > 0) continue;
    plan.notes.push_back(path.string() + ": no points in it, left out");
    indexed.pop_back();
  }
  if (sample.seen() == 0) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("the inputs have no point with a finite position up to {:g}",
                            detect::kSuspectCoordinate));
  }
  choose_scanners(indexed, request.viewpoint, plan);
  check_agreement(indexed, plan);
  choose_las_steps(indexed, plan);
  for (IndexedInput& input : indexed) plan.inputs.push_back(std::move(input.input));
  note_copies(plan);
  if (sample.seen() < plan.points()) {
    plan.notes.push_back(
        fmt::format("{} of {} points have no finite position up to {:g}: kept, unlabelled",
                    plan.points() - sample.seen(), plan.points(), detect::kSuspectCoordinate));
  }
  return sample;
}

/// The places among these, which are in curve order.
std::size_t count_places(std::span<const Vec3> positions) {
  std::size_t copies = 0;
  for (std::size_t i = 1; i < positions.size(); ++i) copies += positions[i] == positions[i - 1];
  return positions.size() - copies;
}

/// The decisions on points and normals.
PreparedSample prepare_sample(const PlanRequest& request, const detect::EdgeModel& model,
                              DenseSample& dense, Plan& plan, const Progress* progress) {
  const detect::PrepareOptions options = {.keep_orientation = request.keep_orientation};
  Thinning thinning;
  if (detect::averages_noise(model)) thinning = thin(options, dense, plan, progress);
  PreparedSample prepared = decide_normals(dense, options, plan, progress);
  plan.normals.averaging = thinning.averaging;
  plan.normals.poles = thinning.poles;
  plan.places = static_cast<std::size_t>(dense.share * static_cast<double>(plan.places));
  return prepared;
}

/// The points that count for the choice of experts, of which `places` are the whole: those of a
/// larger cloud where it is a piece of one.
std::size_t points_for_experts(const PointCloud& whole, std::size_t places, bool keep_orientation,
                               const detect::EdgeModel& model) {
  const bool matter =
      std::any_of(model.experts.begin(), model.experts.end(),
                  [&](const detect::Expert& expert) { return places < expert.kind.below; });
  if (!matter) return places;
  const auto prepared = detect::prepare(whole, {.keep_orientation = keep_orientation});
  return detect::traits_for(model, prepared).points;
}

/// Notes coordinates of a type that rounds them too much. The sample has all points of its places.
void note_float_rounding(const detect::EdgeModel& model, ScalarType type,
                         const PreparedSample& sample, Plan& plan) {
  if (!detect::may_be_too_coarse(type, plan.normals, model.descriptor.range)) return;
  const std::string note = formats::note_on_float(
      plan.box, plan.s_min, detect::share_of_places(sample.positions, sample.curve));
  if (!note.empty()) plan.notes.push_back(note);
}

/// Throws for tiles so short that most have a point or two.
void check_tile_length(double length, const Plan& plan, std::span<const Vec3> sample) {
  constexpr double kMostNumber = 0x1p62;  // of a cell
  constexpr std::size_t kFewTiles = 1000;
  const double farthest = plan.box.farthest();
  if (!(farthest / length < kMostNumber)) {
    throw Error(ErrorKind::kUsage, fmt::format("tiles of length {:g} at coordinates up to {:g}: "
                                               "too short",
                                               length, farthest));
  }
  const std::size_t tiles = count_tiles(sample, length);
  if (tiles > kFewTiles && 2 * tiles > sample.size()) {
    throw Error(ErrorKind::kUsage, fmt::format("tiles of length {:g}: too short, most would have a "
                                               "point or two",
                                               length));
  }
}

/// The length of the cells in which points are counted: the tiles are a whole number of them.
double counting_cell(double tile_length, const Plan& plan, std::span<const Vec3> sample) {
  const double cell = cell_length(plan.box, sample);
  if (tile_length == 0.0) return cell;
  check_tile_length(tile_length, plan, sample);
  double part = tile_length;  // halves of it are exact
  while (part > cell) part *= 0.5;
  return part;
}

Grid grid_of(const PlanRequest& request, const CellCounts& counts, double cell, const Plan& plan) {
  if (request.tile_length == 0.0) {
    return choose_grid(counts, cell, {plan.buffer, request.memory, plan.normals});
  }
  return {cell, static_cast<std::int64_t>(std::llround(request.tile_length / cell))};
}

}  // namespace

Plan make_plan(const PlanRequest& request, const detect::EdgeModel& model,
               const Progress* progress) {
  Plan plan{.version = kVersion, .model = request.model};
  check_inputs_differ(request);
  if (!request.output.empty()) check_template(request.output);
  plan.model.sha256 = sha256_of_file(request.model.path);

  Sample some = index_inputs(request, plan, progress);
  const bool is_all = some.is_all();
  const std::vector<Vec3> sample = some.take();
  plan.places = is_all ? count_places(sample) : some.seen();
  const double cell = counting_cell(request.tile_length, plan, sample);
  check_order_early(request, plan, sample);
  CellCounts counts(cell);

  DenseSample dense = read_dense_sample({sample, is_all}, plan, progress);
  const PreparedSample prepared = prepare_sample(request, model, dense, plan, progress);
  const Spacing spacing =
      measure({sample, is_all}, dense, prepared, plan, model.descriptor.range, counts, progress);
  if (is_all) {
    plan.places = points_for_experts(dense.cloud, plan.places, request.keep_orientation, model);
  }
  plan.s_min = spacing.range.s_min, plan.s_max = spacing.range.s_max;
  note_float_rounding(model, dense.cloud.position_type, prepared, plan);
  decide_voxels(prepared, model, plan, progress);

  set_buffer(model, spacing, plan);
  plan.grid = grid_of(request, counts, cell, plan);
  plan.tiles = lay_out(counts, plan.grid, request.folder,
                       !request.output.empty()  ? request.output
                       : plan.las_steps.empty() ? "{ID}.ply"
                                                : "{ID}.laz");
  for (const Tile& tile : plan.tiles) check_not_input(tile.output, plan.inputs);
  plan.memory = memory_for(most_points(counts, plan.grid, plan.buffer), plan.normals);
  settle_order(request, counts, plan, progress);
  return plan;
}

}  // namespace pcednet::tiles
