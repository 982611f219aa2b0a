#pragma once

#include "pcednet/gls/engine/lane_turns.h"

/// The sums over a neighbourhood, a target per lane.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// Sums over open sources first, once for all gates, then over the rest for each gate.
template <int W, int kGates, bool kPoints>
void sum_lanes(const LaneSources& sources, const LaneTargets& targets,
               [[maybe_unused]] const LaneGate* gates, LaneSums* sums) {
  const auto& [all, open, rest, open_count, rest_count, points] = sources;
  for (int first = 0; first < static_cast<int>(kLanes); first += W) {
    PositionSums<W, kPoints> position[2];
    NormalSums<W, kPoints> normal[2];
    add_turns(all, open, open_count, Targets<W, false>(targets, first, {}), position[0], normal[0]);
    if constexpr (kGates == 1) {
      add_turns(all, rest, rest_count, Targets<W, true>(targets, first, gates[0]), position[0],
                normal[0]);
    }
    if constexpr (kGates == 2) {
      position[1] = position[0], normal[1] = normal[0];
      const Targets<W, true> lanes[2] = {{targets, first, gates[0]}, {targets, first, gates[1]}};
      GatedTurn<W, kPoints> gated;
      for (std::size_t begin = 0; begin < rest_count; begin += kTurn) {
        const std::size_t left = rest_count - begin;
        gated.take(all, rest + begin, left < kTurn ? left : kTurn, lanes);
        for (int g = 0; g < 2; ++g) {
          gated.add_to(g, all, rest + begin, position[g], normal[g]);
        }
      }
      position[1].store_to(sums[1], first), normal[1].store_to(sums[1], first);
    }
    position[0].store_to(sums[0], first), normal[0].store_to(sums[0], first);
  }
}

template <int W>
void sum(const LaneSources& sources, const LaneTargets& targets, const LaneGate* gates,
         std::size_t gate_count, LaneSums* sums) {
  constexpr decltype(&sum_lanes<W, 0, false>) kRuns[3][2] = {
      {sum_lanes<W, 0, false>, sum_lanes<W, 0, true>},
      {sum_lanes<W, 1, false>, sum_lanes<W, 1, true>},
      {sum_lanes<W, 2, false>, sum_lanes<W, 2, true>}};
  kRuns[gate_count][sources.points](sources, targets, gates, sums);
}

/// The neighbours of each lane's target, with a margin for rounding: coordinates in a block's frame
/// are at most 32, so that r^2 is known to 1.4e-5.
template <int W, bool kGated>
void count_lanes(const Source* sources, const std::uint32_t* indices, std::size_t count,
                 const LaneTargets& targets, const LaneGate& gate, LaneCounts& counts) {
  constexpr float kMargin = 2e-5f;
  for (int first = 0; first < static_cast<int>(kLanes); first += W) {
    const Targets<W, kGated> lanes(targets, first, gate);
    Floats<W> surely{}, maybe{};
    for (std::size_t j = 0; j < count; ++j) {
      const Source& s = sources[indices[j]];
      const Lanes3<W> y = lanes.relative(s);
      Floats<W> depth = 1.0f - (y.x * y.x + (y.y * y.y + (y.z * y.z + s.qq)));
      if constexpr (kGated) {
        const Floats<W> slope = lanes.slope(s);
        depth = slope < depth ? slope : depth;
      }
      surely += depth > kMargin ? splat<W>(s.count) : Floats<W>{};
      maybe += depth > -kMargin ? splat<W>(s.count) : Floats<W>{};
    }
    store(counts.surely + first, surely), store(counts.maybe + first, maybe);
  }
}

template <int W>
void count(const Source* sources, const std::uint32_t* indices, std::size_t count,
           const LaneTargets& targets, const LaneGate& gate, LaneCounts& counts) {
  const auto run = gate.enabled ? count_lanes<W, true> : count_lanes<W, false>;
  run(sources, indices, count, targets, gate, counts);
}

}  // namespace
}  // namespace pcednet::gls
