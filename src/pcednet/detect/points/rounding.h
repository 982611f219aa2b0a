#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::detect {

/// The rounding of a cloud to steps of more than a tenth of its spacing, which turns surfaces that
/// are oblique to the axes into stairs, whose treads are level and whose risers look like edges.
/// The smallest step of the three axes counts, so the raster of a terrain model does not count as
/// rounding. Nor does a solid nearly all of whose faces are parallel to the axes or lie on lattice
/// planes: rounding did not move its points.
///
/// Judged by 2,000 points. `curve` is the spatial::curve_order() of the positions.
Rounding find_rounding(std::span<const Vec3> positions, std::span<const std::uint32_t> curve);

/// The positions with a pseudo-random part of half a step at most, up or down, added to each
/// coordinate: the stairs become noise of 0.29 steps. What is added depends on the rounded position
/// relative to the origin alone, so copies of a point stay copies.
std::vector<Vec3> spread(std::span<const Vec3> positions, const Rounding& rounding);

/// For the user, where positions were spread.
std::string note_on(const Rounding& rounding);

/// Whether coordinates of this type may be rounded to more than the spacing, which s_min is then:
/// those of float32, unless `range` gives s_min or prepare() has spread the positions.
bool may_be_too_coarse(ScalarType type, const NormalsDecision& decision,
                       const gls::ScaleRange& range);

/// The share of the points on the curve that are not at the place of an earlier one; 1 if there are
/// none. Where it is low, rounding may have put many at one place.
double share_of_places(std::span<const Vec3> positions, std::span<const std::uint32_t> curve);

/// The smallest scale at which the cloud is described with this range. Throws as
/// gls::scale_range().
double smallest_scale(const PreparedCloud& cloud, const gls::ScaleRange& range);

}  // namespace pcednet::detect
