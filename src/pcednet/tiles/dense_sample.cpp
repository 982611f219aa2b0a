#include "pcednet/tiles/dense_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/median.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/detect/estimates.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/detect/points/scanner_poles.h"
#include "pcednet/detect/points/thinned_cloud.h"
#include "pcednet/gls/engine/fast_scale_space.h"
#include "pcednet/gls/scales.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/tiles/inputs.h"

namespace pcednet::tiles {
namespace {

constexpr std::size_t kCubes = 64;
constexpr std::size_t kDensePoints = 1'000'000;  ///< approximate number in all cubes

// Orienting estimated normals takes the most memory of a plan's steps. It is done in batches of
// many ranges of the curve; the first decides the number of neighbours.
constexpr std::size_t kBatchPoints = 300'000, kStretches = 16;

bool any_holds(std::span<const BoundingBox> cubes, const Vec3& p) {
  return std::any_of(cubes.begin(), cubes.end(),
                     [&](const BoundingBox& cube) { return cube.holds(p); });
}

/// Cubes of one size that together hold about kDensePoints, estimated from the sample.
std::vector<BoundingBox> choose_cubes(std::span<const Vec3> sample, const Plan& plan) {
  std::array<Vec3, kCubes> centres;
  for (std::size_t i = 0; i < kCubes; ++i) {
    centres[i] = sample[(2 * i + 1) * sample.size() / (2 * kCubes)];
  }
  std::vector<double> half_sides(sample.size());  // that reach the point from the nearest centre
  parallel_for_each(sample.size(), [&](std::size_t i) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& centre : centres) {
      least = std::min(least, (sample[i] - centre).cwiseAbs().maxCoeff());
    }
    half_sides[i] = least;
  });
  const double share = static_cast<double>(kDensePoints) / static_cast<double>(plan.points());
  const auto inside = static_cast<std::size_t>(share * static_cast<double>(sample.size()));
  const Vec3 half = Vec3::Constant(value_at_rank(half_sides, std::min(inside, sample.size() - 1)));
  std::vector<BoundingBox> cubes;
  for (const Vec3& centre : centres) cubes.push_back({centre - half, centre + half});
  return cubes;
}

/// All points with a place if there are no cubes.
void append_inside(const PointCloud& part, std::span<const BoundingBox> cubes, PointCloud& to) {
  std::vector<std::uint32_t> inside;
  for (std::uint32_t i = 0; i < part.size(); ++i) {
    const Vec3& position = part.positions[i];
    if (cubes.empty() ? has_place(position) : any_holds(cubes, position)) inside.push_back(i);
  }
  append_surface(part, inside, to);
}

/// Points that are prepared together.
std::vector<std::vector<std::uint32_t>> batches_of(std::span<const Vec3> positions) {
  const std::vector<std::uint32_t> curve = spatial::curve_order(positions);
  std::vector<std::vector<std::uint32_t>> batches((curve.size() - 1) / kBatchPoints + 1);
  const std::size_t stretches = kStretches * batches.size();
  for (std::size_t s = 0; s < stretches; ++s) {
    const auto at = [&](std::size_t stretch) {
      return curve.begin() + static_cast<std::ptrdiff_t>(stretch * curve.size() / stretches);
    };
    auto& batch = batches[s % batches.size()];
    batch.insert(batch.end(), at(s), at(s + 1));
  }
  return batches;
}

/// The points of the first batch.
PointCloud first_batch(const PointCloud& dense) {
  PointCloud points;
  append_surface(dense, batches_of(dense.positions).front(), points);
  return points;
}

/// The beginning of notes on a sample of that many points; empty if they are all.
std::string whose_notes(std::size_t points, bool are_all) {
  return are_all ? "" : fmt::format("in a sample of {} points: ", points);
}

/// `are_all`: whether these are all points that are described.
void note(const detect::PreparedCloud& prepared, bool are_all, Plan& plan) {
  plan.normals = prepared.decision;
  plan.normals.rounding.origin = plan.box.min;  // as of the cloud as a whole
  const std::string whose = whose_notes(prepared.positions.size(), are_all);
  for (const std::string& its : prepared.notes) plan.notes.push_back(whose + its);
}

/// Estimates and orients as prepare() does for points without normals of their own; signs are
/// independent between batches.
std::vector<Vec3> estimate_in_batches(const PointCloud& dense, detect::PrepareOptions options,
                                      Plan& plan, const Progress* progress) {
  std::vector<Vec3> normals(dense.size(), Vec3::Zero());
  for (const std::vector<std::uint32_t>& batch : batches_of(dense.positions)) {
    PointCloud points;
    points.scanners = dense.scanners;
    points.comments = dense.comments;
    append_surface(dense, batch, points);
    const detect::PreparedCloud prepared = detect::prepare(points, options, progress);
    if (!options.decided) note(prepared, false, plan);
    options.decided = plan.normals;
    for (std::size_t i = 0; i < batch.size(); ++i) normals[batch[i]] = prepared.normals[i];
  }
  return normals;
}

/// Whether the normals of the cloud are used, at most with other signs.
bool uses_normals(const PointCloud& cloud, const detect::PrepareOptions& options) {
  return cloud.has_normals() && (options.keep_orientation || !detect::has_estimated_normals(cloud));
}

}  // namespace

PreparedSample decide_normals(const DenseSample& all, const detect::PrepareOptions& options,
                              Plan& plan, const Progress* progress) {
  const PointCloud& dense = all.cloud;
  PreparedSample sample{.is_all = all.is_all};
  if (!uses_normals(dense, options) && dense.size() > kBatchPoints) {
    sample.positions = dense.positions;
    sample.made = estimate_in_batches(dense, options, plan, progress);
    sample.normals = sample.made;
    if (plan.normals.rounding.step > 0.0) {
      sample.moved = detect::spread(dense.positions, plan.normals.rounding);
      sample.positions = sample.moved;
    }
    sample.curve = spatial::curve_order(sample.positions);
    return sample;
  }
  detect::PreparedCloud prepared = detect::prepare(dense, options, progress);
  note(prepared, all.is_all, plan);
  sample.positions = prepared.positions, sample.normals = prepared.normals;
  sample.curve = std::move(prepared.curve);
  sample.moved = std::move(prepared.moved), sample.made = std::move(prepared.made);
  return sample;
}

DenseSample read_dense_sample(const SampledPoints& sample, Plan& plan, const Progress* progress) {
  DenseSample all{.is_all = sample.is_all};
  if (!sample.is_all) all.cubes = choose_cubes(sample.positions, plan);
  const std::vector<BoundingBox>& cubes = all.cubes;
  const auto is_wanted = [&](const Chunk& chunk) {
    return cubes.empty() || std::any_of(cubes.begin(), cubes.end(), [&](const BoundingBox& cube) {
             return cube.meets(chunk.box);
           });
  };
  PointCloud& dense = all.cloud;
  const PointCloud outline = outline_of(plan);
  dense.scanners = plan.scanners;
  dense.position_type = outline.position_type;
  detect::set_estimated_normals(dense, detect::declares_estimated_normals(outline));
  Stage stage(progress, "dense sample", plan.inputs.size());
  for (const PlannedInput& input : plan.inputs) {
    for_each_chunk(input, is_wanted, progress,
                   [&](const PointCloud& part, std::size_t) { append_inside(part, cubes, dense); });
    stage.advance();
  }
  if (dense.has_normals() && detect::has_lost_comments(outline)) {
    plan.estimates = detect::are_estimates(first_batch(dense), progress);
    detect::set_estimated_normals(dense, plan.estimates);
  }
  return all;
}

Thinning thin(const detect::PrepareOptions& options, DenseSample& dense, Plan& plan,
              const Progress* progress) {
  PointCloud& cloud = dense.cloud;
  if (uses_normals(cloud, options)) return {};
  const std::size_t points = cloud.size();
  const std::string whose = whose_notes(points, dense.is_all);
  const auto curve = spatial::curve_order(cloud.positions);
  Thinning thinning;
  if (auto thinned = detect::thin_noise(cloud.positions, curve, progress)) {
    plan.notes.push_back(whose + note_on(*thinned));
    thinning.averaging = thinned->averaging;
    const ScalarType type = cloud.position_type;
    cloud = {};
    cloud.positions = std::move(thinned->positions);
    cloud.position_type = type;
  } else if (const std::vector<Vec3> scanners = scanner_of_points(cloud); !scanners.empty()) {
    const auto found = detect::without_poles(cloud.positions, scanners, curve, progress);
    // In a sample of cubes the rows beside a pole may be missing: tiles find them.
    thinning.poles = found.are_many() || !dense.is_all;
    if (!found.are_many()) return thinning;
    plan.notes.push_back(whose + note_on(found));
    PointCloud kept;
    kept.position_type = cloud.position_type;
    kept.comments = cloud.comments;
    kept.scanners = cloud.scanners;
    append_surface(cloud, found.kept, kept);
    cloud = std::move(kept);
  }
  dense.share = static_cast<double>(cloud.size()) / static_cast<double>(points);
  return thinning;
}

void decide_voxels(const PreparedSample& sample, const detect::EdgeModel& model, Plan& plan,
                   const Progress* progress) {
  gls::ScaleSpaceOptions descriptor = model.descriptor;
  descriptor.range.s_min = plan.s_min, descriptor.range.s_max = plan.s_max;
  const std::size_t octaves = gls::octave_count(descriptor.range);
  // Rounded positions are spread, others averaged: where the sample has all, their box is known.
  const BoundingBox box = sample.is_all ? bounding_box(sample.positions) : plan.box;
  std::optional<gls::FastScaleSpace> space;
  for (std::size_t octave = 0; octave < octaves; ++octave) {
    gls::PyramidPlan& pyramid = plan.pyramids.emplace_back();
    pyramid.corner = box.min;
    pyramid.side = (box.max - box.min).maxCoeff();
    if (plan.model.exact || !gls::fits_spheres(descriptor.reconstruction)) continue;
    if (octave == 0) {
      space.emplace(gls::OrientedPoints{sample.positions, sample.normals, sample.curve}, descriptor,
                    progress);
    } else {
      space->take_octave(octave, nullptr, progress);
    }
    pyramid.levels = space->pyramid_plan().levels;
  }
}

}  // namespace pcednet::tiles
