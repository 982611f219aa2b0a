#pragma once

namespace pcednet::gls {

/// B over t^2 W: below, the neighbours are one place and single out no curvature.
inline constexpr double kSmallestSqSpread = 1e-12;

/// |ul| and the Pratt norm, which are about 1 where normals agree: below, the normals cancel and no
/// surface is singled out.
inline constexpr double kSmallestLength = 1e-4;

/// Of t: after a shorter step the projection on the surface ends.
inline constexpr double kSmallestMove = 0.01;

/// The cosine by which a gate opens, see side_gate().
inline constexpr double kGateWidth = 0.3;

}  // namespace pcednet::gls
