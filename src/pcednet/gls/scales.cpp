#include "pcednet/gls/scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/spatial/middle_half.h"

namespace pcednet::gls {
namespace {

constexpr std::size_t kSample = 16384;
constexpr const char* kSpan =
    "lengths from 1e-100 to 1e100 can be described; are the coordinates right?";
constexpr double kShortest = 1e-100, kLongest = 1e100;  // their squares and inverses are finite

void check_given(double bound, const char* name) {
  if (bound >= 0.0 && std::isfinite(bound)) return;
  throw Error(
      ErrorKind::kUsage,
      fmt::format("{} is {}: a positive number is needed, or 0 for the cloud's own", name, bound));
}

/// Block by block: in another order the last digits of every s_min would change.
double mean_of(std::span<const double> values) {
  constexpr std::size_t kBlock = 256;
  double sum = 0.0;
  for (std::size_t begin = 0; begin < values.size(); begin += kBlock) {
    const auto block = values.subspan(begin, std::min(kBlock, values.size() - begin));
    sum += std::accumulate(block.begin(), block.end(), 0.0);
  }
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double factor_of(std::size_t octave) {
  return static_cast<double>(std::size_t{1} << octave);
}

/// The nearest of the preferred numbers R 20 of ISO 3, which are about 12 % apart.
double preferred_number(double value) {
  if (!(value > kShortest)) return value;
  constexpr std::array kNumbers = {1.0,  1.12, 1.25, 1.4, 1.6, 1.8, 2.0, 2.24, 2.5, 2.8,
                                   3.15, 3.55, 4.0,  4.5, 5.0, 5.6, 6.3, 7.1,  8.0, 9.0};
  constexpr int kOfDecade = static_cast<int>(kNumbers.size());
  const int step = static_cast<int>(std::lround(kOfDecade * std::log10(value)));
  const int decade = static_cast<int>(std::floor(step / static_cast<double>(kOfDecade)));
  const double number = kNumbers[static_cast<std::size_t>(step - decade * kOfDecade)];
  return decade < 0 ? number / std::pow(10.0, -decade) : number * std::pow(10.0, decade);
}

ScaleRange tied_range(const ScaleRange& given,
                      const std::function<std::vector<double>()>& spacings) {
  std::vector<double> all = spacings();
  const std::span<const double> half = spatial::middle_half(all);
  ScaleRange range = given;
  if (range.s_min == 0.0) {
    range.s_min = range.rounded ? preferred_number(mean_of(half)) : mean_of(half);
  }
  if (range.s_max == 0.0) {
    const bool has_octaves = given.octaves && spatial::is_uneven(half);
    range.s_max = range.s_max_ratio * range.s_min * (has_octaves ? factor_of(kOctaves - 1) : 1.0);
  }
  return range;
}

/// The paper's range.
ScaleRange range_by_extent(const ScaleRange& given, double diagonal,
                           const std::function<std::vector<double>()>& spacings) {
  ScaleRange range = given;
  if (range.s_min == 0.0) range.s_min = mean_of(spacings());
  if (range.s_max > 0.0) return range;
  range.s_max = given.s_max_fraction * diagonal;
  if (!(range.s_min < range.s_max)) range.s_max = kSparseRange * range.s_min;
  return range;
}

}  // namespace

std::size_t octave_count(const ScaleRange& range) {
  constexpr double kRounding = 1e-6;
  if (!range.octaves || range.s_max_ratio <= 0.0) return 1;
  const double first = (1.0 - kRounding) * range.s_max_ratio * range.s_min;
  std::size_t count = 1;
  while (count < kOctaves && range.s_max >= first * factor_of(count)) ++count;
  return count;
}

ScaleRange at_octave(const ScaleRange& range, std::size_t octave) {
  if (octave_count(range) == 1) return range;
  ScaleRange own = range;
  own.s_min = factor_of(octave) * range.s_min;
  own.s_max = range.s_max_ratio * own.s_min;
  return own;
}

double mean_distance(std::span<const double> sq_distances) {
  double sum = 0.0;
  for (std::size_t i = 1; i < sq_distances.size(); ++i) sum += std::sqrt(sq_distances[i]);
  return sum / static_cast<double>(sq_distances.size() - 1);
}

std::vector<double> sampled_spacings(std::size_t points,
                                     const std::function<double(std::size_t)>& distance) {
  if (points < 2) return {};
  constexpr std::size_t kBlock = 256;
  std::vector<double> spacings(std::min(points, kSample));
  parallel_blocks(spacings.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) spacings[i] = distance(i * points / spacings.size());
  });
  return spacings;
}

std::vector<double> spacings_of_places(std::span<const Vec3> positions,
                                       std::span<const std::uint32_t> curve) {
  const std::vector<Vec3> places =
      spatial::in_order(positions, spatial::firsts_of_places(positions, curve));
  const spatial::KdTree tree(places);
  return sampled_spacings(places.size(), [&](std::size_t place) {
    std::array<double, kSpacingNeighbours> sq_distances;
    const std::size_t found = tree.nearest(places[place], sq_distances);
    return mean_distance(std::span(sq_distances).first(found));
  });
}

ScaleRange scale_range(std::span<const Vec3> positions, const ScaleRange& given,
                       const std::function<std::vector<double>()>& spacings) {
  check_given(given.s_min, "s_min");
  check_given(given.s_max, "s_max");
  check_given(given.s_max_fraction, "s_max_fraction");
  check_given(given.s_max_ratio, "s_max_ratio");
  const bool both_given = given.s_min > 0.0 && given.s_max > 0.0;
  const double diagonal = bounding_box(positions).diagonal();
  if (!both_given && !(diagonal > kShortest && diagonal < kLongest)) {
    throw Error(ErrorKind::kInsufficient,
                diagonal > 0.0 ? fmt::format("the points extend over {:.6g}: {}", diagonal, kSpan)
                               : "no scales: finite points at two places or more are needed");
  }
  const ScaleRange range = both_given                ? given
                           : given.s_max_ratio > 0.0 ? tied_range(given, spacings)
                                                     : range_by_extent(given, diagonal, spacings);
  if (kShortest < range.s_min && range.s_min < range.s_max && range.s_max < kLongest) return range;
  if (0.0 < range.s_min && range.s_min < range.s_max) {
    const bool is_given = given.s_min > 0.0 || given.s_max > 0.0;
    throw Error(is_given ? ErrorKind::kUsage : ErrorKind::kInsufficient,
                fmt::format("scales from {:.3g} to {:.3g}: {}", range.s_min, range.s_max, kSpan));
  }
  throw Error(
      ErrorKind::kUsage,
      fmt::format(
          "no scales from {:.6g} to {:.6g}: the largest, s_max, must be above the smallest, "
          "s_min, which is {}",
          range.s_min, range.s_max,
          given.s_min > 0.0 ? "given" : "the spacing of the points if not given"));
}

std::string note_on_extent(const ScaleSpaceOptions& options, double diagonal,
                           std::string_view whose, const RangeNames& names) {
  if (!(diagonal > 0.0)) return {};
  const auto larger = [&](std::string_view name, double scale) {
    return fmt::format("{}{} {:g} is larger than the cloud, whose diagonal is {:.4g}", whose, name,
                       scale, diagonal);
  };
  if (options.range.s_min > diagonal)
    throw Error(ErrorKind::kUsage, larger(names.s_min, options.range.s_min));
  return options.range.s_max > diagonal ? larger(names.s_max, options.range.s_max) : std::string();
}

std::vector<double> sample_scales(const ScaleRange& whole, int count) {
  const ScaleRange range = at_octave(whole, 0);
  if (count < kMinScales || count > kMaxScales ||
      !std::has_single_bit(static_cast<unsigned>(count))) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} scales: 4, 8, 16, 32, 64 or 128 are possible", count));
  }
  if (!(range.s_min > kShortest && range.s_min < range.s_max && range.s_max < kLongest)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("no scales from {} to {}", range.s_min, range.s_max));
  }
  std::vector<double> scales(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    scales[static_cast<std::size_t>(i)] =
        range.s_min * std::pow(range.s_max / range.s_min, i / (count - 1.0));
  }
  return scales;
}

}  // namespace pcednet::gls
