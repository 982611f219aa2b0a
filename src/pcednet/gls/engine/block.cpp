#include "pcednet/gls/engine/block.h"

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

/// The distance from every point within which a source is in its support, for any qq.
float inner_reach(const BlockFrame& frame, float margin) {
  const double sq_inverse_t = frame.inverse_t() * frame.inverse_t();
  const double sq_inner = std::max(0.0, 1.0 - frame.level().most_qq * sq_inverse_t);
  return static_cast<float>(std::sqrt(sq_inner) - 1e-4) - margin;
}

/// Keeps, of the inner sources, those that every gate admits fully.
void keep_open(Part& part, const Source* sources, const NormalBox& normals, float open_from,
               const LaneKernels& kernels) {
  Candidates& inside = part.inside.view;
  std::uint32_t* const rest = part.gated.rest.make(inside.count);
  const std::size_t open = kernels.part_open(sources, inside.index, inside.count, normals,
                                             open_from, inside.index, rest);
  for (std::size_t j = 0; j < inside.count - open; ++j) part.near.add(rest[j], sources[rest[j]]);
  inside.count = open;
}

}  // namespace

void GroupBoxes::cover(VoxelSpan points, std::size_t begin, std::size_t end) {
  if (begin >= begin_ && end <= end_) return;
  points_ = points, begin_ = begin, end_ = end;
  boxes_.clear(), normals_.clear();
  for (std::size_t first = begin; first < end; first += kLanes) {
    TargetBox box = {points.position(first), points.position(first)};
    Normals normals = {points.normal(first), points.normal(first)};
    for (std::size_t i = first + 1; i < std::min(first + kLanes, end); ++i) {
      box.grow(points.position(i));
      normals.grow({points.normal(i), points.normal(i)});
    }
    boxes_.push_back(box), normals_.push_back(normals);
  }
}

void GroupBoxes::Normals::grow(const Normals& other) {
  for (std::size_t a = 0; a < 3; ++a) {
    min[a] = std::min(min[a], other.min[a]);
    max[a] = std::max(max[a], other.max[a]);
  }
}

TargetBox GroupBoxes::box_of(std::size_t begin, std::size_t end) const {
  TargetBox box = {points_.position(begin), points_.position(begin)};
  const bool groups = begin % kLanes == 0 && (end % kLanes == 0 || end == end_);
  for (std::size_t i = begin; i < end; i += groups ? kLanes : 1) {
    if (groups) {
      const TargetBox& group = boxes_[(i - begin_) / kLanes];
      box.grow(group.min), box.grow(group.max);
    } else {
      box.grow(points_.position(i));
    }
  }
  return box;
}

bool may_be_open(const NormalBox& normals, float open_from) {
  float sq_most = 0.0f;
  for (int a = 0; a < 3; ++a) {
    const float most = std::max(0.0f, std::abs(normals.middle[a]) - normals.half[a]);
    sq_most += most * most;
  }
  return sq_most > open_from * open_from;
}

NormalBox GroupBoxes::normals_of(std::size_t begin, std::size_t end) const {
  const std::size_t first = (begin - begin_) / kLanes, last = (end - 1 - begin_) / kLanes;
  Normals all = normals_[first];
  for (std::size_t g = first + 1; g <= last; ++g) all.grow(normals_[g]);
  NormalBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.middle[a] = 0.5f * (all.min[a] + all.max[a]);
    box.half[a] = 0.5f * (all.max[a] - all.min[a]);
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

bool gather(Block& block, std::size_t begin, std::size_t end, const TargetBox& box,
            const VoxelLevel& level, double t, float margin, std::size_t most) {
  const float reach = kReach + margin;
  const bool again =
      begin == block.begin && end == block.end && block.frame.holds(level, reach * t);
  if (again) {
    block.frame.rescale(t);
    return true;
  }
  block.begin = begin, block.end = end;
  return block.frame.gather(level, box, box.centre(), t, reach, most);
}

Sources choose_part(Block& block, std::size_t depth, const Sources& all, const SourceBox& box,
                    const NormalBox& normals, const Reach& reach, const LaneKernels& kernels) {
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
  const bool gated = reach.open_from > 0.0f;
  if (sq_half < kWidestSummed * kWidestSummed &&
      (!gated || may_be_open(normals, reach.open_from))) {
    kernels.split(all.near, box, kReach + reach.margin, inner_reach(block.frame, reach.margin),
                  near, inside);
    if (gated && inside.count >= kFewestSummed) {
      keep_open(part, block.frame.sources(), normals, reach.open_from, kernels);
    }
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
