#include "pcednet/gls/block_evaluator.h"

#include <algorithm>
#include <cmath>

#include "pcednet/gls/features.h"

namespace pcednet::gls {
namespace {

/// A block is divided into parts of these many points, those again, and the last into groups.
constexpr std::array<std::size_t, BlockEvaluator::kDepth> kParts = {64 * kLanes, 8 * kLanes,
                                                                    2 * kLanes, kLanes};
constexpr std::size_t kFewestShared = 32;  // below, summing them once is no gain
constexpr float kWidestShared = 0.7f;      // t: half the diagonal of a part with any inside
constexpr double kWidestBlock = 64;        // t: float then gives coordinates to 2e-6
constexpr float kRounding = 0x1p-24f;      // of a float
constexpr float kReach = 1.00001f;         // t: the support, and what rounding may add
constexpr float kMargin = 0.25f;           // t: gathered in advance for points that will move

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

/// The box of all lanes in `targets`, in the frame.
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

/// True if whatever is closer than 1 to `box` is closer than 1 + margin to `gathered`.
bool is_within(const SourceBox& box, const SourceBox& gathered, float margin) {
  const float slack = margin * 0.57f;  // on each axis: 1 / sqrt(3)
  for (int a = 0; a < 3; ++a) {
    if (box.min[a] < gathered.min[a] - slack || box.max[a] > gathered.max[a] + slack) return false;
  }
  return true;
}

/// How far rounding may move the sums at these targets: by a few steps of a float for the sums
/// themselves, and for each coordinate by half a step of its size.
float rounding_at(const SourceBox& box) {
  float farthest = 0.0f;
  for (int a = 0; a < 3; ++a) {
    farthest = std::max({farthest, std::abs(box.min[a]), std::abs(box.max[a])});
  }
  return kRounding * (8.0f + 4.0f * farthest);
}

void clear(GroupFit& result, std::size_t lane) {
  result.status[lane] = FitStatus::kUndefined;
  for (auto& feature : result.fits.features) feature[lane] = 0.0f;
  result.fits.uc[lane] = result.fits.uq[lane] = 0.0f;
  result.fits.pratt[lane] = 1.0f;
}

void copy_lane(const GroupFit& from, std::size_t lane, GroupFit& to) {
  to.status[lane] = from.status[lane];
  const LaneFits& f = from.fits;
  LaneFits& t = to.fits;
  for (std::size_t k = 0; k < std::size(f.features); ++k) {
    t.features[k][lane] = f.features[k][lane];
  }
  for (std::size_t a = 0; a < 3; ++a) t.ul[a][lane] = f.ul[a][lane];
  t.uc[lane] = f.uc[lane], t.uq[lane] = f.uq[lane], t.pratt[lane] = f.pratt[lane];
}

void put(const RecheckedFit& exact, double t, std::size_t lane, GroupFit& result) {
  std::array<double, 28> features;
  write_features(FeatureSet::kAll28, exact.descriptor, t, features);
  bool finite = true;
  for (std::size_t k = 0; k < features.size(); ++k) {
    const auto feature = static_cast<float>(features[k]);
    result.fits.features[k][lane] = feature;
    finite = finite && std::isfinite(feature);
  }
  if (!finite || exact.fit.status == FitStatus::kUndefined) return clear(result, lane);
  result.status[lane] = exact.fit.status;
  const AlgebraicSphere& sphere = exact.fit.sphere;
  result.fits.uc[lane] = static_cast<float>(sphere.uc / t);
  for (int a = 0; a < 3; ++a) {
    result.fits.ul[a][lane] = static_cast<float>(sphere.ul[a]);
  }
  result.fits.uq[lane] = static_cast<float>(sphere.uq * t);
  result.fits.pratt[lane] = static_cast<float>(sphere.pratt);
}

}  // namespace

BlockEvaluator::BlockEvaluator(const VoxelPyramid& pyramid, const BlockOptions& options,
                               const LaneKernels& kernels)
    : pyramid_(&pyramid), options_(options), kernels_(&kernels) {
  if (options.side_gate) {
    gate_ = {.enabled = true, .threshold = static_cast<float>(*options.side_gate)};
  }
}

void BlockEvaluator::find_boxes(std::size_t begin, std::size_t end) {
  if (begin >= boxes_begin_ && end <= boxes_end_) return;
  boxes_begin_ = begin, boxes_end_ = end;
  boxes_.clear();
  const std::vector<Voxel>& points = pyramid_->levels.front().voxels;
  for (std::size_t first = begin; first < end; first += kLanes) {
    TargetBox box = {points[first].position, points[first].position};
    for (std::size_t i = first + 1; i < std::min(first + kLanes, end); ++i)
      box.grow(points[i].position);
    boxes_.push_back(box);
  }
}

TargetBox BlockEvaluator::box_of(std::size_t begin, std::size_t end) const {
  const std::vector<Voxel>& points = pyramid_->levels.front().voxels;
  TargetBox box = {points[begin].position, points[begin].position};
  const bool groups = begin % kLanes == 0 && (end % kLanes == 0 || end == boxes_end_);
  for (std::size_t i = begin; i < end; i += groups ? kLanes : 1) {
    if (groups) {
      const TargetBox& group = boxes_[(i - boxes_begin_) / kLanes];
      box.grow(group.min), box.grow(group.max);
    } else {
      box.grow(points[i].position);
    }
  }
  return box;
}

void BlockEvaluator::evaluate(std::size_t begin, std::size_t end, std::size_t scale, double t,
                              const Wanted& wanted, const Emit& emit) {
  find_boxes(begin, end);
  const TargetBox box = box_of(begin, end);
  if (box.longest_side() > kWidestBlock * t && end - begin > 1) {
    const std::size_t groups = (end - begin + kLanes - 1) / kLanes;
    const std::size_t half = begin + (groups > 1 ? groups / 2 * kLanes : (end - begin) / 2);
    evaluate(begin, half, scale, t, wanted, emit);
    evaluate(half, end, scale, t, wanted, emit);
    return;
  }
  margin_ = options_.projection_steps > 0 ? kMargin : 0.0f;
  const Visit visit = {t, wanted, emit};
  if (!any_wanted(begin, end, wanted)) return;
  gather_block(begin, end, pyramid_->levels[pyramid_->level_of[scale]], box, t, kReach + margin_);
  visit_parts(0, begin, end, block_.candidates(), {}, visit);
}

bool BlockEvaluator::any_wanted(std::size_t begin, std::size_t end, const Wanted& wanted) {
  for (std::size_t first = begin; first < end; first += kLanes) {
    if (wanted({first, std::min(kLanes, end - first)})) return true;
  }
  return false;
}

/// Describes the points [begin, end) from the sources `near`: all that may reach them but for those
/// that parts of lesser depth share.
void BlockEvaluator::visit_parts(std::size_t depth, std::size_t begin, std::size_t end,
                                 const Candidates& near, const SourceBox& box, const Visit& visit) {
  const std::size_t size = kParts[depth];
  for (std::size_t first = begin; first < end; first += size) {
    const std::size_t last = std::min(first + size, end);
    if (!any_wanted(first, last, visit.wanted)) continue;
    if (size == kLanes) {
      const LaneGroup group = {first, last - first};
      evaluate_group(group, block_, near, box, visit.t, result_);
      visit.emit(group, result_);
    } else {
      const SourceBox part_box = local_box(block_, box_of(first, last));
      choose_sources(near, part_box, parts_[depth]);
      visit_parts(depth + 1, first, last, parts_[depth].near.view, part_box, visit);
      parts_[depth].inside.view.count = 0;
    }
  }
}

/// A level that served a larger scale before need not be searched again.
void BlockEvaluator::gather_block(std::size_t begin, std::size_t end, const VoxelLevel& level,
                                  const TargetBox& box, double t, float reach) {
  const bool again = begin == gathered_begin_ && end == gathered_end_ &&
                     &level == gathered_level_ && reach * t <= block_.reach();
  if (again) return block_.rescale(t);
  block_.gather(level, box, box.centre(), t, reach);
  gathered_begin_ = begin, gathered_end_ = end, gathered_level_ = &level;
}

/// Chooses the sources near a part, and sums up those inside the support of its every point.
void BlockEvaluator::choose_sources(const Candidates& all, const SourceBox& box, Part& part) {
  part.near.reserve(all.count), part.inside.reserve(all.count);
  part.inside.view.x = nullptr;  // the indices are enough
  float sq_half = 0.0f;
  for (int a = 0; a < 3; ++a) {
    const float half = 0.5f * (box.max[a] - box.min[a]);
    sq_half += half * half;
    part.sums.centre[a] = box.min[a] + half;
  }
  if (!gate_.enabled && sq_half < kWidestShared * kWidestShared) {
    const double sq_inverse_t = block_.inverse_t() * block_.inverse_t();
    const double sq_inner = std::max(0.0, 1.0 - block_.level().most_qq * sq_inverse_t);
    const auto inner = static_cast<float>(std::sqrt(sq_inner) - 1e-4) - margin_;
    kernels_->split(all, box, kReach + margin_, inner, part.near.view, part.inside.view);
    const Candidates& inside = part.inside.view;
    if (inside.count >= kFewestShared) {
      return kernels_->sum_inside(block_.sources(), inside.index, inside.count, part.sums);
    }
  }
  part.inside.view.count = 0;
  kernels_->select(all, box, kReach + margin_, part.near.view);
}

void BlockEvaluator::load_targets(const LaneGroup& group, const BlockFrame& frame) {
  const std::vector<Voxel>& points = pyramid_->levels.front().voxels;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Voxel& point = points[group.begin + std::min(lane, group.count - 1)];
    const Vec3 local = frame.local(point.position);
    targets_.x[lane] = static_cast<float>(local.x());
    targets_.y[lane] = static_cast<float>(local.y());
    targets_.z[lane] = static_cast<float>(local.z());
    targets_.nx[lane] = point.normal[0];
    targets_.ny[lane] = point.normal[1];
    targets_.nz[lane] = point.normal[2];
  }
}

void BlockEvaluator::evaluate_group(const LaneGroup& group, const BlockFrame& frame,
                                    const Candidates& near, const SourceBox& gathered, double t,
                                    GroupFit& result) {
  load_targets(group, frame);
  for (auto& offset : offset_) offset.fill(0.0f);
  fit_lanes(group, frame, near, t, result);
  if (options_.projection_steps > 0) project(group, frame, near, gathered, t, result);
}

/// Fits every lane where targets_ has it; `near` must hold all that is closer than 1 to them.
void BlockEvaluator::fit_lanes(const LaneGroup& group, const BlockFrame& frame,
                               const Candidates& near, double t, GroupFit& result) {
  group_.reserve(near.count);
  group_.view.x = nullptr;  // the indices are enough
  const SourceBox box = gls::box_of(targets_);
  kernels_->select(near, box, kReach, group_.view);
  const Candidates& sources = group_.view;
  kernels_->sum(frame.sources(), sources.index, sources.count, targets_, gate_,
                frame.level().cell == 0.0, sums_);
  interactions_ += sources.count * group.count;
  for (const Part& part : shared(frame)) {
    if (part.inside.view.count > 0) kernels_->add_inside(part.sums, targets_, sums_);
  }
  find_status(group, frame, t, result);
  kernels_->solve(sums_, options_.detail, rounding_at(box), result.fits);
  settle(group, frame, t, result);
}

/// Counts neighbours only where the sum of weights, each at most 1, does not tell that there are
/// many.
void BlockEvaluator::find_status(const LaneGroup& group, const BlockFrame& frame, double t,
                                 GroupFit& result) {
  result.status.fill(FitStatus::kStable);
  const auto few = [&](std::size_t lane) { return !(sums_.u[lane] > 6.001f); };
  bool any = false;
  for (std::size_t lane = 0; lane < group.count; ++lane) any = any || few(lane);
  if (!any) return;
  const Candidates& sources = group_.view;
  kernels_->count(frame.sources(), sources.index, sources.count, targets_, gate_, counts_);
  float inside = 0.0f;
  for (const Part& part : shared(frame)) {
    if (part.inside.view.count > 0) inside += part.sums.moments[0][0];
  }
  for (std::size_t lane = 0; lane < group.count; ++lane) {
    if (!few(lane)) continue;
    const auto status = [inside](float count) {
      return status_of_count(static_cast<std::uint32_t>(std::min(count + inside, 1e9f)));
    };
    result.status[lane] = status(counts_.surely[lane]);
    if (status(counts_.maybe[lane]) == result.status[lane]) continue;
    result.status[lane] =
        recheck_status(doubtful(group, lane, t), frame.level(), candidate_voxels(frame));
  }
}

/// Zeros for what is undefined, double precision for what float could not tell.
void BlockEvaluator::settle(const LaneGroup& group, const BlockFrame& frame, double t,
                            GroupFit& result) {
  for (std::size_t lane = 0; lane < group.count; ++lane) {
    const float verdict = result.fits.verdict[lane];
    if (result.status[lane] == FitStatus::kUndefined || verdict == kVoid) {
      clear(result, lane);
    } else if (verdict == kDoubtful) {
      put(recheck_fit(doubtful(group, lane, t), frame.level(), candidate_voxels(frame)), t, lane,
          result);
    }
  }
}

DoubtfulTarget BlockEvaluator::doubtful(const LaneGroup& group, std::size_t lane, double t) const {
  const Voxel& point = pyramid_->levels.front().voxels[group.begin + lane];
  const auto& offset = offset_[lane];
  return {point.position, Vec3(offset[0], offset[1], offset[2]) * t,
          Vec3(point.normal[0], point.normal[1], point.normal[2]), t, options_.side_gate};
}

std::span<const std::uint32_t> BlockEvaluator::candidate_voxels(const BlockFrame& frame) {
  voxels_.clear();
  const auto add = [&](const Candidates& some) {
    for (std::size_t i = 0; i < some.count; ++i) voxels_.push_back(frame.voxel(some.index[i]));
  };
  add(group_.view);
  for (const Part& part : shared(frame)) add(part.inside.view);
  return voxels_;
}

/// Chooses each moving lane's next step, projection_move(). False if no lane moves.
bool BlockEvaluator::step(const LaneGroup& group, GroupFit& result) {
  bool any = false;
  const LaneFits& f = result.fits;
  for (std::size_t lane = 0; lane < group.count; ++lane) {
    moving_[lane] = moving_[lane] && result.status[lane] == FitStatus::kStable;
    if (!moving_[lane]) continue;
    any = true;
    float sq_length = 0.0f;
    for (std::size_t a = 0; a < 3; ++a) sq_length += f.ul[a][lane] * f.ul[a][lane];
    const float length = std::sqrt(sq_length);
    const float factor = -2.0f * f.uc[lane] / (length * (length + f.pratt[lane]));
    for (std::size_t a = 0; a < 3; ++a) move_[lane][a] = factor * f.ul[a][lane];
  }
  return any;
}

/// As ExactScaleSpace does it: moves the evaluation points onto the surface until they hardly move.
void BlockEvaluator::project(const LaneGroup& group, const BlockFrame& frame,
                             const Candidates& near, const SourceBox& gathered, double t,
                             GroupFit& result) {
  constexpr float kSmallestMove = 0.01f;
  moving_.fill(true);
  for (int i = 0; i < options_.projection_steps && step(group, result); ++i) {
    const LaneTargets before = targets_;
    const auto offset_before = offset_;
    float* rows[3] = {targets_.x, targets_.y, targets_.z};
    for (std::size_t lane = 0; lane < group.count; ++lane) {
      for (std::size_t a = 0; moving_[lane] && a < 3; ++a) {
        rows[a][lane] += move_[lane][a];
        offset_[lane][a] += move_[lane][a];
      }
    }
    const SourceBox box = gls::box_of(targets_);
    if (is_within(box, gathered, kMargin)) {
      fit_lanes(group, frame, near, t, next_);
    } else {
      TargetBox moved;
      for (int a = 0; a < 3; ++a) {
        moved.min[a] = frame.origin()[a] + box.min[a] * t;
        moved.max[a] = frame.origin()[a] + box.max[a] * t;
      }
      own_.gather(frame.level(), moved, frame.origin(), t, kReach);
      fit_lanes(group, own_, own_.candidates(), t, next_);
    }
    for (std::size_t lane = 0; lane < group.count; ++lane) {
      if (!moving_[lane]) continue;
      const auto& m = move_[lane];
      if (next_.status[lane] == FitStatus::kUndefined) {
        moving_[lane] = false;
        targets_.x[lane] = before.x[lane], targets_.y[lane] = before.y[lane];
        targets_.z[lane] = before.z[lane];
        offset_[lane] = offset_before[lane];
        continue;
      }
      copy_lane(next_, lane, result);
      const float sq_move = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
      if (sq_move < kSmallestMove * kSmallestMove) moving_[lane] = false;
    }
  }
  for (std::size_t lane = 0; lane < group.count; ++lane) {
    if (result.status[lane] == FitStatus::kUndefined) continue;
    // The distance of the point itself to the last surface.
    const LaneFits& f = result.fits;
    float value = f.uc[lane];
    for (std::size_t a = 0; a < 3; ++a) {
      value += offset_[lane][a] * (f.uq[lane] * offset_[lane][a] - f.ul[a][lane]);
    }
    result.fits.features[0][lane] = value / f.pratt[lane];
  }
}

}  // namespace pcednet::gls
