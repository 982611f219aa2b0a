#pragma once

namespace pcednet::gls {

/// The least B / (t^2 W): below it, the neighbours coincide and determine no curvature.
inline constexpr double kSmallestSqSpread = 1e-12;

/// The least |ul| and Pratt norm, which are about 1 where normals agree: below it, the normals
/// cancel and determine no surface.
inline constexpr double kSmallestLength = 1e-4;

/// The projection onto the surface ends after a step shorter than this fraction of t.
inline constexpr double kSmallestMove = 0.01;

/// The cosine by which a gate opens, see side_gate().
inline constexpr double kGateWidth = 0.3;

}  // namespace pcednet::gls
