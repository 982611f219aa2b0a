#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/gls/scale_space_options.h"

namespace pcednet::gls {

/// The largest scale over the smallest, for clouds too sparse for the paper's range.
inline constexpr double kSparseRange = 2.0;

/// In uneven clouds points may be described at scales 2, 4 or 8 times larger than those of octave
/// 0, which end s_max_ratio above s_min.
inline constexpr std::size_t kOctaves = 4;

/// Mean distances to the 10 nearest other places (to all others if there are fewer): for every
/// place or, if there are more than 16384, for 16384 at equal steps along the curve order.
/// `distance(place)` is that of a place of the order.
std::vector<double> sampled_spacings(std::size_t points,
                                     const std::function<double(std::size_t)>& distance);

/// The mean distance in a row of nearest squared distances; the first, to the point itself, is left
/// out.
double mean_distance(std::span<const double> sq_distances);

/// The number of nearest points, including the point itself, that mean_distance() takes.
inline constexpr std::size_t kSpacingNeighbours = 11;

/// The range of scales of the finite `positions`. Bounds other than 0 in `given` are kept.
///
/// With an s_max_ratio: s_min is the mean of the middle half of `spacings()`, if `rounded` the
/// nearest preferred number (R 20 of ISO 3: 1, 1.12, 1.25, ... 9, 10), so that most pieces of a
/// cloud have the same, and s_max = s_max_ratio s_min, or with octaves that of the last octave if
/// the third quartile of the spacings is more than 1.6 times the first. Neither the extent nor a
/// few far points change the range.
///
/// Without one, the paper's range: s_min = the mean of `spacings()`, s_max = s_max_fraction (10 %)
/// of the diagonal of the bounding box. Where this gives no range, an s_max that was not given and
/// is not above s_min (a sparse cloud: fewer than some 330 points on a cube) becomes kSparseRange
/// times s_min; see note_on().
///
/// Throws Error(kInsufficient) for fewer than two places, and for lengths beyond 1e-100 to 1e100,
/// unless both bounds are given, Error(kUsage) if a given bound is negative, not finite, or leaves
/// no range.
ScaleRange scale_range(std::span<const Vec3> positions, const ScaleRange& given,
                       const std::function<std::vector<double>()>& spacings);

/// The spacings of the places of points, which `curve` lists along their curve: copies of a point
/// do not make the others denser.
std::vector<double> spacings_of_places(std::span<const Vec3> positions,
                                       std::span<const std::uint32_t> curve);

/// How many octaves a range has: 1 to kOctaves, as many as end at s_max or below.
std::size_t octave_count(const ScaleRange& range);

/// The range of an octave: of several, from 2^octave s_min to s_max_ratio times that.
ScaleRange at_octave(const ScaleRange& range, std::size_t octave);

/// What a user calls the bounds of the range.
struct RangeNames {
  std::string_view s_min, s_max;
};

/// Throws Error(kUsage) if the given s_min is larger than a cloud of this diagonal. Returns a
/// sentence for the user if the given s_max is, otherwise an empty one. Both begin with `whose`.
std::string note_on_extent(const ScaleSpaceOptions& options, double diagonal,
                           std::string_view whose, const RangeNames& names);

/// `count` scales, smallest first: s_i = s_min (s_max / s_min)^((i - 1) / (count - 1)); of several
/// octaves, those of the first.
/// Throws Error(kUsage) unless count is 4, 8, 16, 32, 64 or 128 and 0 < s_min < s_max.
std::vector<double> sample_scales(const ScaleRange& whole, int count);

}  // namespace pcednet::gls
