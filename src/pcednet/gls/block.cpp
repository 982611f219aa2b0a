#include "pcednet/gls/block.h"

#include <algorithm>
#include <cmath>

namespace pcednet::gls {
namespace {

constexpr std::size_t kFewestSummed = 32;  // below, summing them once is no gain
constexpr float kWidestSummed = 0.7f;      // t: half the diagonal of a part with any inside

/// The least (or with `sign` -1 the greatest) of a row of lanes.
float extreme(const float (&row)[kLanes], float sign) {
  float least[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) least[i] = sign * row[i];
  for (std::size_t half = kLanes / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) {
      least[i] = least[i] < least[i + half] ? least[i] : least[i + half];
    }
  }
  return sign * least[0];
}

/// How near a source must be to every point to be within its support whatever its qq.
float inner_reach(const BlockFrame& frame, float margin) {
  const double sq_inverse_t = frame.inverse_t() * frame.inverse_t();
  const double sq_inner = std::max(0.0, 1.0 - frame.level().most_qq * sq_inverse_t);
  return static_cast<float>(std::sqrt(sq_inner) - 1e-4) - margin;
}

}  // namespace

void GroupBoxes::cover(std::span<const Voxel> points, std::size_t begin, std::size_t end) {
  if (begin >= begin_ && end <= end_) return;
  points_ = points, begin_ = begin, end_ = end;
  boxes_.clear();
  for (std::size_t first = begin; first < end; first += kLanes) {
    TargetBox box = {points[first].position, points[first].position};
    for (std::size_t i = first + 1; i < std::min(first + kLanes, end); ++i) {
      box.grow(points[i].position);
    }
    boxes_.push_back(box);
  }
}

TargetBox GroupBoxes::box_of(std::size_t begin, std::size_t end) const {
  TargetBox box = {points_[begin].position, points_[begin].position};
  const bool groups = begin % kLanes == 0 && (end % kLanes == 0 || end == end_);
  for (std::size_t i = begin; i < end; i += groups ? kLanes : 1) {
    if (groups) {
      const TargetBox& group = boxes_[(i - begin_) / kLanes];
      box.grow(group.min), box.grow(group.max);
    } else {
      box.grow(points_[i].position);
    }
  }
  return box;
}

SourceBox box_of(const LaneTargets& targets) {
  return {{extreme(targets.x, 1.0f), extreme(targets.y, 1.0f), extreme(targets.z, 1.0f)},
          {extreme(targets.x, -1.0f), extreme(targets.y, -1.0f), extreme(targets.z, -1.0f)}};
}

SourceBox local_box(const BlockFrame& frame, const TargetBox& box) {
  const Vec3 min = frame.local(box.min), max = frame.local(box.max);
  SourceBox local;
  for (int a = 0; a < 3; ++a) {
    local.min[a] = static_cast<float>(min[a]), local.max[a] = static_cast<float>(max[a]);
  }
  return local;
}

bool is_within(const SourceBox& box, const SourceBox& gathered, float margin) {
  const float slack = margin * 0.57f;  // on each axis: 1 / sqrt(3)
  for (int a = 0; a < 3; ++a) {
    if (box.min[a] < gathered.min[a] - slack || box.max[a] > gathered.max[a] + slack) return false;
  }
  return true;
}

void gather(Block& block, std::size_t begin, std::size_t end, const TargetBox& box,
            const VoxelLevel& level, double t, float margin) {
  const float reach = kReach + margin;
  const bool again =
      begin == block.begin && end == block.end && block.frame.holds(level, reach * t);
  if (again) return block.frame.rescale(t);
  block.frame.gather(level, box, box.centre(), t, reach);
  block.begin = begin, block.end = end;
}

Sources choose_part(Block& block, std::size_t depth, const Sources& all, const SourceBox& box,
                    const Reach& reach, const LaneKernels& kernels) {
  Part& part = block.parts[depth];
  part.near.reserve(all.near.count), part.inside.reserve(all.near.count);
  part.inside.view.x = nullptr;  // the indices are enough
  float sq_half = 0.0f;
  for (int a = 0; a < 3; ++a) {
    const float half = 0.5f * (box.max[a] - box.min[a]);
    sq_half += half * half;
    part.sums.centre[a] = box.min[a] + half;
  }
  Candidates& near = part.near.view;
  Candidates& inside = part.inside.view;
  if (reach.inside && sq_half < kWidestSummed * kWidestSummed) {
    kernels.split(all.near, box, kReach + reach.margin, inner_reach(block.frame, reach.margin),
                  near, inside);
  }
  if (inside.count >= kFewestSummed) {
    kernels.sum_inside(block.frame.sources(), inside.index, inside.count, part.sums);
  } else {
    inside.count = 0;
    kernels.select(all.near, box, kReach + reach.margin, near);
  }
  return {all.frame, near, std::span(block.parts).first(depth + 1), box};
}

}  // namespace pcednet::gls
