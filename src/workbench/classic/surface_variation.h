#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"

namespace pcednet::classic {

/// The surface variation of Pauly, Gross and Kobbelt 2002 at every position:
///
///     sigma = l0 / (l0 + l1 + l2),   l0 <= l1 <= l2 the eigenvalues of
///     C = 1/k sum (p_j - m)(p_j - m)^T,   m = 1/k sum p_j
///
/// over the `neighbours` nearest points, including the point itself. From 0 (plane) to 1/3
/// (isotropic); 0 where all neighbours coincide, NaN where the position is not finite.
/// The same for any number of threads and any order of the points. Throws Error(kUsage) for fewer
/// than 4 neighbours, Error(kInsufficient) for fewer finite points than neighbours.
std::vector<double> surface_variation(std::span<const Vec3> positions, int neighbours,
                                      const Progress* progress = nullptr);

}  // namespace pcednet::classic
