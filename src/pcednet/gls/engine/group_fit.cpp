#include "pcednet/gls/engine/group_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pcednet/gls/engine/lane_recheck.h"
#include "pcednet/gls/features.h"
#include "pcednet/gls/fit_limits.h"

namespace pcednet::gls {
namespace {

constexpr float kRounding = 0x1p-24f;  // of a float

/// The same for all gates up to 0.4, so that two of them divide the sources as each alone would.
constexpr double kLeastOpen = 0.4 + kGateWidth;

/// The sources that a fit reads one by one.
struct NearSources {
  const Sources* all;
  Candidates chosen;
};

/// A bound on the effect of rounding on the sums at these targets: a few steps of a float for the
/// sums themselves, and half a step of its magnitude for each coordinate.
float rounding_at(const SourceBox& box) {
  float farthest = 0.0f;
  for (int a = 0; a < 3; ++a) {
    farthest = std::max({farthest, std::abs(box.min[a]), std::abs(box.max[a])});
  }
  return kRounding * (8.0f + 4.0f * farthest);
}

LaneGate lane_gate(const Gate& gate) {
  return gate ? LaneGate{.enabled = true, .threshold = static_cast<float>(*gate)} : LaneGate{};
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

DoubtfulTarget doubtful(const Group& group, std::size_t lane, double t, const Gate& gate) {
  const Voxel point = group.points[lane];
  const auto& offset = group.offsets[lane];
  return {point.position, Vec3(offset[0], offset[1], offset[2]) * t,
          Vec3(point.normal[0], point.normal[1], point.normal[2]), t, gate};
}

/// The voxels of the sources.
std::span<const std::uint32_t> voxels_of(const NearSources& near,
                                         std::vector<std::uint32_t>& voxels) {
  voxels.clear();
  const auto add = [&](const Candidates& some) {
    for (std::size_t i = 0; i < some.count; ++i) {
      voxels.push_back(near.all->frame->voxel(some.index[i]));
    }
  };
  add(near.chosen);
  for (const Part& part : near.all->summed) add(part.inside.view);
  return voxels;
}

/// Counts neighbours only if the sum of weights `u`, each at most 1, does not imply that there are
/// many.
void find_status(const Group& group, const NearSources& near, const float (&u)[kLanes],
                 const Gate& gate, const FitOptions& options, FitBuffers& buffers,
                 GroupFit& result) {
  result.status.fill(FitStatus::kStable);
  const auto few = [&](std::size_t lane) { return !(u[lane] > 6.001f); };
  bool any = false;
  for (std::size_t lane = 0; lane < group.points.size(); ++lane) any = any || few(lane);
  if (!any) return;
  const BlockFrame& frame = *near.all->frame;
  LaneCounts counts;
  options.kernels->count(frame.sources(), near.chosen.index, near.chosen.count, group.targets,
                         lane_gate(gate), counts);
  float inside = 0.0f;
  for (const Part& part : near.all->summed) {
    if (part.inside.view.count > 0) inside += part.sums.moments[0][0];
  }
  const auto status = [inside](float count) {
    return status_of_count(static_cast<std::uint32_t>(std::min(count + inside, 1e9f)));
  };
  for (std::size_t lane = 0; lane < group.points.size(); ++lane) {
    if (!few(lane)) continue;
    result.status[lane] = status(counts.surely[lane]);
    if (status(counts.maybe[lane]) == result.status[lane]) continue;
    result.status[lane] = recheck_status(doubtful(group, lane, options.t, gate), frame.level(),
                                         voxels_of(near, buffers.voxels));
  }
}

/// Zeros for undefined fits, double precision where float is too coarse.
void settle(const Group& group, const NearSources& near, const Gate& gate, double t,
            FitBuffers& buffers, GroupFit& result) {
  for (std::size_t lane = 0; lane < group.points.size(); ++lane) {
    const float verdict = result.fits.verdict[lane];
    if (result.status[lane] == FitStatus::kUndefined || verdict == kVoid) {
      clear(result, lane);
    } else if (verdict == kDoubtful) {
      put(recheck_fit(doubtful(group, lane, t, gate), near.all->frame->level(),
                      voxels_of(near, buffers.voxels)),
          t, lane, result);
    }
  }
}

void sum(const Group& group, const NearSources& near, std::span<const Gate> gates,
         const LaneKernels& kernels, GatedList& gated, LaneSums (&sums)[2]) {
  const BlockFrame& frame = *near.all->frame;
  LaneSources sources = {.all = frame.sources(),
                         .open = near.chosen.index,
                         .rest = nullptr,
                         .open_count = near.chosen.count,
                         .rest_count = 0,
                         .points = frame.level().cell == 0.0};
  if (!gates.front()) return kernels.sum(sources, group.targets, nullptr, 0, sums);
  const float open = open_from(gates);
  if (may_be_open(group.normals, open)) {
    std::uint32_t* const opened = gated.open.make(near.chosen.count);
    std::uint32_t* const rest = gated.rest.make(near.chosen.count);
    sources.open_count = kernels.part_open(sources.all, near.chosen.index, near.chosen.count,
                                           group.normals, open, opened, rest);
    sources.open = opened, sources.rest = rest;
  } else {
    std::swap(sources.open, sources.rest);
    sources.open_count = 0;
  }
  sources.rest_count = near.chosen.count - sources.open_count;
  const LaneGate both[2] = {lane_gate(gates.front()), lane_gate(gates.back())};
  kernels.sum(sources, group.targets, both, gates.size(), sums);
}

/// The next step of each lane, and whether it moves at all.
struct Moves {
  std::array<std::array<float, 3>, kLanes> by;  ///< in t
  std::array<bool, kLanes> on;

  bool is_short(std::size_t lane) const {
    const auto& m = by[lane];
    constexpr float least = kSmallestMove;
    return m[0] * m[0] + m[1] * m[1] + m[2] * m[2] < least * least;
  }
};

/// Chooses the next step of each lane that still moves, projection_move(). False if none does.
bool choose(Moves& moves, const GroupFit& fit, std::size_t lanes) {
  bool any = false;
  const LaneFits& f = fit.fits;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    moves.on[lane] = moves.on[lane] && fit.status[lane] == FitStatus::kStable;
    if (!moves.on[lane]) continue;
    any = true;
    float sq_length = 0.0f;
    for (std::size_t a = 0; a < 3; ++a) sq_length += f.ul[a][lane] * f.ul[a][lane];
    const float length = std::sqrt(sq_length);
    const float factor = -2.0f * f.uc[lane] / (length * (length + f.pratt[lane]));
    for (std::size_t a = 0; a < 3; ++a) moves.by[lane][a] = factor * f.ul[a][lane];
  }
  return any;
}

Group moved(const Group& group, const Moves& moves) {
  Group next = group;
  float* rows[3] = {next.targets.x, next.targets.y, next.targets.z};
  for (std::size_t lane = 0; lane < group.points.size(); ++lane) {
    for (std::size_t a = 0; moves.on[lane] && a < 3; ++a) {
      rows[a][lane] += moves.by[lane][a];
      next.offsets[lane][a] += moves.by[lane][a];
    }
  }
  next.box = box_of(next.targets);
  return next;
}

void copy_lane(const Group& from, std::size_t lane, Group& to) {
  to.targets.x[lane] = from.targets.x[lane], to.targets.y[lane] = from.targets.y[lane];
  to.targets.z[lane] = from.targets.z[lane];
  to.offsets[lane] = from.offsets[lane];
}

/// The sources around points that have moved: those at hand, or else newly gathered.
Sources sources_at(const SourceBox& box, const Sources& at_hand, double t, BlockFrame& own) {
  if (is_within(box, at_hand.box, kMargin)) return at_hand;
  const BlockFrame& frame = *at_hand.frame;
  TargetBox there;
  for (int a = 0; a < 3; ++a) {
    there.min[a] = frame.origin()[a] + box.min[a] * t;
    there.max[a] = frame.origin()[a] + box.max[a] * t;
  }
  own.gather(frame.level(), there, frame.origin(), t, kReach);
  return {&own, own.candidates(), {}, box};
}

/// tau of each original point, not of its moved position: its distance to the last surface.
void measure_tau(const Group& group, GroupFit& fit) {
  LaneFits& f = fit.fits;
  for (std::size_t lane = 0; lane < group.points.size(); ++lane) {
    if (fit.status[lane] == FitStatus::kUndefined) continue;
    const auto& offset = group.offsets[lane];
    float value = f.uc[lane];
    for (std::size_t a = 0; a < 3; ++a) {
      value += offset[a] * (f.uq[lane] * offset[a] - f.ul[a][lane]);
    }
    f.features[0][lane] = value / f.pratt[lane];
  }
}

}  // namespace

float open_from(std::span<const Gate> gates) {
  if (!gates.front()) return 0.0f;
  constexpr double kSlack = 1e-4;  // for rounding
  double from = kLeastOpen;
  for (const Gate& gate : gates) from = std::max(from, *gate + kGateWidth);
  return static_cast<float>(from + kSlack);
}

Group place(VoxelSpan points, const BlockFrame& frame, const SourceBox& box,
            const NormalBox& normals) {
  Group group = {.points = points, .targets = {}, .box = box, .normals = normals};
  LaneTargets& targets = group.targets;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Voxel point = points[std::min(lane, points.size() - 1)];
    const Vec3 local = frame.local(point.position);
    targets.x[lane] = static_cast<float>(local.x());
    targets.y[lane] = static_cast<float>(local.y());
    targets.z[lane] = static_cast<float>(local.z());
    targets.nx[lane] = point.normal[0];
    targets.ny[lane] = point.normal[1];
    targets.nz[lane] = point.normal[2];
  }
  return group;
}

void fit(const Group& group, const Sources& sources, std::span<const Gate> gates,
         const FitOptions& options, FitBuffers& buffers, std::span<GroupFit> fits) {
  const LaneKernels& kernels = *options.kernels;
  buffers.near.reserve(sources.near.count);
  Candidates& chosen = buffers.near.view;
  chosen.x = nullptr;  // the indices are enough
  kernels.select(sources.near, group.box, kReach, chosen);
  LaneSums sums[2];
  sum(group, {&sources, chosen}, gates, kernels, buffers.gated, sums);
  for (std::size_t g = 0; g < gates.size(); ++g) {
    for (const Part& part : sources.summed) {
      if (part.inside.view.count > 0) kernels.add_inside(part.sums, group.targets, sums[g]);
    }
    const NearSources near = {&sources, chosen};
    find_status(group, near, sums[g].u, gates[g], options, buffers, fits[g]);
    kernels.solve(sums[g], options.detail, rounding_at(group.box), fits[g].fits);
    settle(group, near, gates[g], options.t, buffers, fits[g]);
  }
}

void project(Group group, const Sources& sources, const Gate& gate, const FitOptions& options,
             FitBuffers& buffers, GroupFit& fit) {
  Moves moves;
  moves.on.fill(true);
  GroupFit next;
  const std::size_t lanes = group.points.size();
  for (int i = 0; i < options.projection_steps && choose(moves, fit, lanes); ++i) {
    const Group there = moved(group, moves);
    gls::fit(there, sources_at(there.box, sources, options.t, buffers.own), {&gate, 1}, options,
             buffers, {&next, 1});
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!moves.on[lane]) continue;
      moves.on[lane] = next.status[lane] != FitStatus::kUndefined;
      if (!moves.on[lane]) continue;
      copy_lane(next, lane, fit), copy_lane(there, lane, group);
      moves.on[lane] = !moves.is_short(lane);
    }
  }
  measure_tau(group, fit);
}

}  // namespace pcednet::gls
