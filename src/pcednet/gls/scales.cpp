#include "pcednet/gls/scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"

namespace pcednet::gls {
namespace {

constexpr std::size_t kNeighbours = 10;
constexpr double kPartOfDiagonal = 0.1;
constexpr double kShortest = 1e-100, kLongest = 1e100;  // their squares and inverses are finite

double mean_neighbour_distance(const Vec3& position, const spatial::KdTree& tree,
                               std::vector<spatial::Neighbour>& found) {
  tree.nearest(position, kNeighbours + 1, found);
  double sum = 0.0;
  for (std::size_t i = 1; i < found.size(); ++i) sum += std::sqrt(found[i].sq_distance);
  return sum / static_cast<double>(found.size() - 1);
}

void check_given(double bound, const char* name) {
  if (bound >= 0.0 && std::isfinite(bound)) return;
  throw Error(
      ErrorKind::kUsage,
      fmt::format("{} is {}: a positive length is needed, or 0 for the cloud's own", name, bound));
}

}  // namespace

double mean_spacing(std::span<const Vec3> positions, const spatial::KdTree& tree) {
  if (tree.size() < 2) return 0.0;
  constexpr std::size_t kBlock = 1024;
  std::vector<double> sums((positions.size() + kBlock - 1) / kBlock);
  parallel_blocks(positions.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      sums[begin / kBlock] += mean_neighbour_distance(positions[i], tree, found);
    }
  });
  double sum = 0.0;
  for (const double block : sums) sum += block;
  return sum / static_cast<double>(positions.size());
}

ScaleRange scale_range(std::span<const Vec3> positions, const spatial::KdTree& tree,
                       const ScaleRange& given) {
  check_given(given.s_min, "s_min");
  check_given(given.s_max, "s_max");
  ScaleRange range = given;
  const double diagonal = bounding_box(positions).diagonal();
  if (range.s_max == 0.0) range.s_max = kPartOfDiagonal * diagonal;
  if (!(range.s_max > kShortest && range.s_max < kLongest)) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("no scales for {} finite points with a bounding box of diagonal {}: "
                            "points at two places or more are needed",
                            tree.size(), diagonal));
  }
  if (range.s_min == 0.0) range.s_min = mean_spacing(positions, tree);
  if (!(range.s_min > kShortest)) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("the {} finite points are all copies of each other or have ten copies "
                            "each: remove duplicates",
                            tree.size()));
  }
  if (range.s_min < range.s_max) return range;
  const bool both_given = given.s_min > 0.0 && given.s_max > 0.0;
  throw Error(
      both_given ? ErrorKind::kUsage : ErrorKind::kInsufficient,
      fmt::format("the smallest scale {} is not below the largest {}{}", range.s_min, range.s_max,
                  both_given ? "" : ": too few points for their extent; give s_min and s_max"));
}

std::vector<double> sample_scales(const ScaleRange& range, int count) {
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
