#include "pcednet/gls/engine/block_evaluator.h"

#include <algorithm>
#include <limits>

namespace pcednet::gls {
namespace {

/// A block is divided into parts of these many points, those again, and the last into groups.
constexpr std::array<std::size_t, Block::kDepth> kParts = {64 * kLanes, 8 * kLanes, 2 * kLanes,
                                                           kLanes};
constexpr double kWidestBlock = 64;  // t: float then gives coordinates to 2e-6
constexpr double kCompactBlock = 4;  // t: no larger than the neighbourhood of every point
/// Five times the usual: a block that the curve scatters is divided.
constexpr std::size_t kMostSources = 8 * 4096;

bool any_wanted(std::size_t begin, std::size_t end, const BlockEvaluator::Wanted& wanted) {
  for (std::size_t first = begin; first < end; first += kLanes) {
    if (wanted({first, std::min(kLanes, end - first)})) return true;
  }
  return false;
}

}  // namespace

BlockEvaluator::BlockEvaluator(const VoxelPyramid& pyramid, const BlockOptions& options,
                               const LaneKernels& kernels)
    : pyramid_(&pyramid), options_(options), kernels_(&kernels) {}

void BlockEvaluator::evaluate(std::size_t begin, std::size_t end, std::size_t scale, double t,
                              const Wanted& wanted, const Emit& emit) {
  boxes_.cover(pyramid_->levels.front().voxels, begin, end);
  const TargetBox box = boxes_.box_of(begin, end);
  if (box.longest_side() > kWidestBlock * t && end - begin > 1) {
    return evaluate_halves(begin, end, scale, t, wanted, emit);
  }
  if (!any_wanted(begin, end, wanted)) return;
  const Visit visit = {{t, options_.detail, options_.projection_steps, kernels_},
                       {.margin = options_.projection_steps > 0 ? kMargin : 0.0f,
                        .open_from = open_from(options_.gates)},
                       wanted,
                       emit};
  const bool scattered = end - begin > 1 && box.longest_side() > kCompactBlock * t;
  const bool gathered = gather(block_, begin, end, box, pyramid_->levels[pyramid_->level_of[scale]],
                               t, visit.reach.margin,
                               scattered ? kMostSources : std::numeric_limits<std::size_t>::max());
  if (!gathered) return evaluate_halves(begin, end, scale, t, wanted, emit);
  visit_parts(0, begin, end, {&block_.frame, block_.frame.candidates(), {}, {}}, visit);
}

void BlockEvaluator::evaluate_halves(std::size_t begin, std::size_t end, std::size_t scale,
                                     double t, const Wanted& wanted, const Emit& emit) {
  const std::size_t groups = (end - begin + kLanes - 1) / kLanes;
  const std::size_t half = begin + (groups > 1 ? groups / 2 * kLanes : (end - begin) / 2);
  evaluate(begin, half, scale, t, wanted, emit);
  evaluate(half, end, scale, t, wanted, emit);
}

/// Describes the points [begin, end) from `sources`.
void BlockEvaluator::visit_parts(std::size_t depth, std::size_t begin, std::size_t end,
                                 const Sources& sources, const Visit& visit) {
  const std::size_t size = kParts[depth];
  for (std::size_t first = begin; first < end; first += size) {
    const std::size_t last = std::min(first + size, end);
    if (!any_wanted(first, last, visit.wanted)) continue;
    if (size == kLanes) {
      visit_group({first, last - first}, sources, visit);
    } else {
      const SourceBox box = local_box(block_.frame, boxes_.box_of(first, last));
      const NormalBox normals = normals_of(first, last, visit);
      visit_parts(depth + 1, first, last,
                  choose_part(block_, depth, sources, box, normals, visit.reach, *kernels_), visit);
    }
  }
}

/// The box of the points' normals, if there are gates.
NormalBox BlockEvaluator::normals_of(std::size_t begin, std::size_t end, const Visit& visit) const {
  return visit.reach.open_from > 0.0f ? boxes_.normals_of(begin, end) : NormalBox{};
}

void BlockEvaluator::visit_group(const LaneGroup& group, const Sources& sources,
                                 const Visit& visit) {
  const VoxelSpan points = pyramid_->levels.front().voxels;
  const std::size_t end = group.begin + group.count;
  const Group here = place(points.subspan(group.begin, group.count), block_.frame,
                           local_box(block_.frame, boxes_.box_of(group.begin, end)),
                           normals_of(group.begin, end, visit));
  const std::span<const Gate> gates = options_.gates;
  const auto fits = std::span(fits_).first(gates.size());
  fit(here, sources, gates, visit.fit, buffers_, fits);
  for (std::size_t g = 0; g < gates.size() && visit.fit.projection_steps > 0; ++g) {
    project(here, sources, gates[g], visit.fit, buffers_, fits[g]);
  }
  visit.emit(group, fits);
}

}  // namespace pcednet::gls
