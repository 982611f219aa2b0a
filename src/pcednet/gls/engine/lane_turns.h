#pragma once

#include "pcednet/gls/engine/lane_terms.h"

/// The sums over a neighbourhood, some sources at a time.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// The two kinds of sums do not fit the registers together: they take turns on this many sources,
/// and the second reads from the nearest cache what the first knows of them. Each turn is summed by
/// itself, so that rounding hardly grows with the number of sources.
constexpr std::size_t kTurn = 48;

/// Adds the sums over the sources of a turn: interact(sums, j) adds the j-th to the first kind.
template <int W, bool kPoints, typename Interact, typename SourceAt>
inline void add_turn(std::size_t count, const Interact& interact, const SourceAt& source_at,
                     PositionSums<W, kPoints>& position, NormalSums<W, kPoints>& normal) {
  Interaction<W> turn[kTurn];
  PositionSums<W, kPoints> position_turn;
  for (std::size_t j = 0; j < count; ++j) turn[j] = interact(position_turn, j);
  position += position_turn;
  NormalSums<W, kPoints> normal_turn;
  for (std::size_t j = 0; j < count; ++j) normal_turn.add(source_at(j), turn[j]);
  normal += normal_turn;
}

/// Adds the sums over some sources, turn by turn. Not inlined: the sums take nearly all registers.
template <int W, bool kGated, bool kPoints>
[[gnu::noinline]] void add_turns(const Source* sources, const std::uint32_t* indices,
                                 std::size_t count, const Targets<W, kGated>& lanes,
                                 PositionSums<W, kPoints>& position,
                                 NormalSums<W, kPoints>& normal) {
  for (std::size_t begin = 0; begin < count; begin += kTurn) {
    const std::size_t here = count - begin < kTurn ? count - begin : kTurn;
    const auto source_at = [&](std::size_t j) -> const Source& {
      return sources[indices[begin + j]];
    };
    add_turn(
        here,
        [&](PositionSums<W, kPoints>& sums, std::size_t j) {
          return sums.add(source_at(j), lanes);
        },
        source_at, position, normal);
  }
}

/// The sources of a turn behind two gates. Where they are is computed once; those that a gate shuts
/// out for every target add nothing, and are left out.
template <int W, bool kPoints>
struct GatedTurn {
  Relation<W> relations[kTurn];
  Floats<W> weights[2][kTurn];
  std::uint32_t let_in[2][kTurn];  ///< which of the turn
  std::size_t count[2];

  void take(const Source* sources, const std::uint32_t* indices, std::size_t from,
            const Targets<W, true> (&lanes)[2]) {
    count[0] = count[1] = 0;
    for (std::size_t j = 0; j < from; ++j) {
      const Source& s = sources[indices[j]];
      relations[j] = relate<kPoints>(s, lanes[0]);
      for (int g = 0; g < 2; ++g) {
        weights[g][j] = relations[j].weight * lanes[g].gate(s);
        let_in[g][count[g]] = static_cast<std::uint32_t>(j);
        count[g] += any_positive(weights[g][j]) ? 1 : 0;
      }
    }
  }

  [[gnu::noinline]] void add_to(int g, const Source* sources, const std::uint32_t* indices,
                                PositionSums<W, kPoints>& position,
                                NormalSums<W, kPoints>& normal) const {
    add_turn(
        count[g],
        [&](PositionSums<W, kPoints>& sums, std::size_t j) {
          const std::uint32_t i = let_in[g][j];
          return sums.add(relations[i], weights[g][i]);
        },
        [&](std::size_t j) -> const Source& { return sources[indices[let_in[g][j]]]; }, position,
        normal);
  }
};

}  // namespace
}  // namespace pcednet::gls
