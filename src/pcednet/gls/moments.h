#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/neighbourhood.h"

namespace pcednet::gls {

/// Sums over a neighbourhood with one kind of weight (w, or one of its derivatives): all that the
/// sphere fit needs of the points. y is a position relative to x, n a unit normal.
struct Moments {
  double w = 0.0;         ///< W  = S w
  Vec3 p = Vec3::Zero();  ///< P  = S w y
  Vec3 n = Vec3::Zero();  ///< N  = S w n
  double pn = 0.0;        ///< PN = S w y.n
  double pp = 0.0;        ///< PP = S w |y|^2
};

/// The moments and their derivatives. Only weights are differentiated; y and n are constants, since
/// the fitted field is evaluated in the frame of x.
struct MomentSet {
  std::uint32_t count = 0;  ///< neighbours summed
  Moments value;
  Moments dt;                 ///< with dw/dt in place of w
  std::array<Moments, 3> dx;  ///< with dw/dx_k
};

/// Sums over the neighbours in the given order; all must be closer than `t`.
MomentSet sum_moments(std::span<const LocalNeighbour> neighbours, double t);

}  // namespace pcednet::gls
