#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

inline constexpr std::size_t kNoPartner = static_cast<std::size_t>(-1);

/// What partners string together, each entered at an end; closed if the last leads to the first.
struct EndString {
  std::vector<std::size_t> entries;
  bool closed = false;
};

/// Ends 2 i and 2 i + 1 are those of member i; `partner` has for each the end that it meets, or
/// kNoPartner. Every member is in one string, alone if it meets none. Those that begin at a free
/// end come first, in the order of their first members, then the closed ones.
std::vector<EndString> follow_partners(std::span<const std::size_t> partner);

/// Joins pieces that continue each other smoothly over gaps up to `gap` into polylines: edges that
/// are neither straight nor round. They may bend by `angle` (radians) where they join. A segment
/// and an arc, or two segments, stay separate if both are long: their kind is certain.
void string_together(std::vector<Piece>& pieces, double gap, double angle);

/// Polylines all nodes of which are within `tolerance` (in spacings) of a few segments and arcs, at
/// most `most`, become these. Throws Error(kCancelled) once the caller cancels.
void divide_strings(std::vector<Piece>& pieces, double tolerance, std::size_t most,
                    const Progress* progress = nullptr);

/// The same as string_together() for pieces of noisy points with their final extents: two that lie
/// side by side, or overlap, and both end free, are one edge regardless of their kinds. Ends in
/// corners (see free_ends(); `noise` is in spacings) stay.
void string_free_ends(std::vector<Piece>& pieces, double gap, double angle, double noise);

/// The vertices of a polyline that stays within `tolerance` of all `places`, the ends kept.
std::vector<Vec3> simplified(const std::vector<Vec3>& places, double tolerance);

}  // namespace pcednet::lines
