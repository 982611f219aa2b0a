#include "pcednet/gls/engine/fast_scale_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/gls/engine/block_evaluator.h"
#include "pcednet/gls/engine/target_groups.h"
#include "pcednet/gls/scales.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::gls {
namespace {

/// The rows of LaneFits::features that a set takes, in its order.
std::vector<std::size_t> rows_of(FeatureSet set) {
  switch (set) {
    case FeatureSet::kSpatial4:
      return {0, 1, 2, 5};
    case FeatureSet::kRelief3:
      return {0, 3, 5};
    default:
      break;
  }
  std::vector<std::size_t> rows(static_cast<std::size_t>(feature_count(set)));
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = k;
  return rows;
}

LaneDetail detail_of(FeatureSet set) {
  if (set == FeatureSet::kRelief3) return LaneDetail::kRelief;
  return set == FeatureSet::kAll28 ? LaneDetail::kAll : LaneDetail::kInvariant;
}

/// Writes the features of a lane with every gate, and returns the worst of its statuses.
FitStatus put(std::span<const GroupFit> fits, std::size_t lane, std::span<const std::size_t> rows,
              std::span<float> out) {
  auto status = fits.front().status[lane];
  auto to = out.begin();
  for (const GroupFit& fit : fits) {
    status = std::max(status, fit.status[lane]);
    for (const std::size_t row : rows) *to++ = fit.fits.features[row][lane];
  }
  return status;
}

/// The power of two that scales the cloud's longest side to between 1/2 and 2, so that squares and
/// cubes of its lengths fit a float; exact.
double unit_for(const BoundingBox& box) {
  if (box.empty()) return 1.0;
  const double half_side = (0.5 * box.max - 0.5 * box.min).maxCoeff();
  if (!(half_side > 0.0)) return 1.0;
  return std::ldexp(1.0, std::clamp(-std::ilogb(half_side), -1000, 1000));
}

}  // namespace

FastScaleSpace::FastScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                               const Progress* progress)
    : FastScaleSpace(points, options, lane_kernels(), progress) {}

FastScaleSpace::FastScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                               const LaneKernels& kernels, const Progress* progress)
    : options_(options), kernels_(&kernels) {
  check(points, options);
  if (!fits_spheres(options.reconstruction)) {
    throw Error(ErrorKind::kUsage, "the fast engine reconstructs with algebraic spheres only");
  }
  Stage stage(progress, "prepare", 3);
  PointOrder ordered = point_order(points);
  stage.advance();
  std::vector<std::uint32_t> distinct = distinct_points(points, ordered);
  order_ = std::move(ordered.order);
  places_ = distinct.size();
  unit_ = unit_for(bounding_box(points.positions));
  {
    std::vector<std::uint32_t> groups = distinct;
    arrange_in_groups(points.positions, groups);
    place_ = places_in(groups, points.positions.size());
    pyramid_ = make_pyramid(points.positions, points.normals, groups, unit_, points.whole);
    stage.advance();
    find_range(points, distinct, ordered.shares_places);
    add_copies(points, groups, order_, place_);
  }
  std::vector<std::uint32_t>().swap(distinct);  // before the levels take their memory
  stage.advance();
  take_scales(range_, points.whole, progress);
}

void FastScaleSpace::take_octave(std::size_t octave, const PyramidPlan* whole,
                                 const Progress* progress) {
  take_scales(at_octave(range_, octave), whole, progress);
}

void FastScaleSpace::take_scales(const ScaleRange& range, const PyramidPlan* whole,
                                 const Progress* progress) {
  scales_ = sample_scales(range, options_.scales);
  std::vector<double> scaled = scales_;
  for (double& scale : scaled) scale *= unit_;
  make_levels(pyramid_, scaled,
              {.eps = options_.eps, .gated = options_.side_gate.has_value(), .whole = whole},
              progress);
}

PyramidPlan FastScaleSpace::pyramid_plan() const {
  return {pyramid_.origin / unit_, pyramid_.side / unit_, pyramid_.plan};
}

void FastScaleSpace::find_range(OrientedPoints points, std::span<const std::uint32_t> curve,
                                bool may_share_places) {
  const VoxelLevel& level = pyramid_.levels.front();
  const VoxelSpan voxels = level.voxels;
  const auto distance = [&](std::size_t i) {
    std::array<double, kSpacingNeighbours> sq_distances;
    const std::size_t found = level.boxes.nearest(
        place_[curve[i]], sq_distances, [&](std::size_t place) { return voxels.position(place); });
    return mean_distance(std::span(sq_distances).first(found)) / unit_;
  };
  const auto spacings = [&] {
    return may_share_places && spatial::have_copies(points.positions, curve)
               ? spacings_of_places(points.positions, curve)
               : sampled_spacings(curve.size(), distance);
  };
  range_ = scale_range(points.positions, options_.range, spacings);
}

void FastScaleSpace::describe(std::span<const std::uint32_t> targets, std::span<float> out,
                              std::span<FitStatus> status, const Progress* progress) const {
  const auto width = static_cast<std::size_t>(column_count(options_));
  check_room(targets.size(), scales_.size(), width, out.size(), status.size());
  const std::vector<Visit> visits = plan_visits(targets, place_);
  std::vector<std::size_t> blocks;  // where each begins
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (i == 0 || visits[i].place / kPointsTogether != visits[i - 1].place / kPointsTogether)
      blocks.push_back(i);
  }
  blocks.push_back(visits.size());
  Stage stage(progress, "describe", visits.size());
  parallel_blocks(blocks.size() - 1, 1, [&](std::size_t begin, std::size_t) {
    const std::size_t count = blocks[begin + 1] - blocks[begin];
    describe_block(std::span(visits).subspan(blocks[begin], count), out, status);
    stage.advance(count);
  });
}

/// Fills the rows of visits to one block.
void FastScaleSpace::describe_block(std::span<const Visit> visits, std::span<float> out,
                                    std::span<FitStatus> status) const {
  const std::vector<std::size_t> rows = rows_of(options_.features);
  const auto width = static_cast<std::size_t>(column_count(options_));
  if (visits.front().place == kNowhere) {
    for (const Visit& visit : visits) {
      const std::size_t first = visit.row * scales_.size();
      std::fill_n(&status[first], scales_.size(), FitStatus::kUndefined);
      std::fill_n(&out[first * width], scales_.size() * width, 0.0f);
    }
    return;
  }
  const std::size_t begin = visits.front().place / kPointsTogether * kPointsTogether;
  const std::size_t end = std::min(begin + kPointsTogether, places_);
  std::array<std::uint32_t, kPointsTogether + 1>
      first_visit;  // to each place of the block, or later
  for (std::size_t i = 0, v = 0; i <= kPointsTogether; ++i) {
    while (v < visits.size() && visits[v].place < begin + i) ++v;
    first_visit[i] = static_cast<std::uint32_t>(v);
  }
  const auto visits_to = [&](const LaneGroup& group) {
    const std::size_t first = first_visit[group.begin - begin];
    return visits.subspan(first, first_visit[group.begin - begin + group.count] - first);
  };
  const bool moves = projects(options_.reconstruction);
  BlockEvaluator evaluator(pyramid_,
                           {.detail = detail_of(options_.features),
                            .projection_steps = moves ? options_.max_projection_steps : 0,
                            .gates = gates_of(options_)},
                           *kernels_);
  for (std::size_t s = scales_.size(); s-- > 0;) {  // the largest first: see gather()
    evaluator.evaluate(
        begin, end, s, scales_[s] * unit_,
        [&](const LaneGroup& group) { return !visits_to(group).empty(); },
        [&](const LaneGroup& group, std::span<const GroupFit> fits) {
          for (const Visit& visit : visits_to(group)) {
            const std::size_t cell = visit.row * scales_.size() + s;
            if (&visit + kLanes < visits.data() + visits.size()) {  // soon written, too
              __builtin_prefetch(&out[((&visit)[kLanes].row * scales_.size() + s) * width], 1);
            }
            status[cell] = put(fits, visit.place - group.begin, rows, out.subspan(cell * width));
          }
        });
  }
}

}  // namespace pcednet::gls
