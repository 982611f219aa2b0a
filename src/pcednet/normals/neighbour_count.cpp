#include "pcednet/normals/neighbour_count.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/normals/local_counts.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::normals {
namespace {

constexpr std::array<std::size_t, 3> kCounts = {12, 24, 48};

constexpr double kNarrow = 0.1;  ///< median width of neighbourhoods along lines
/// The distance of the last neighbour to that of a quarter of them: 2 on a surface, 4 on a line.
constexpr double kLinear = 2.5;
constexpr double kClean = 0.01;  ///< median thickness
constexpr double kExactShare = 0.17;
constexpr std::size_t kFew = 4000;  ///< fewer say too little about their surroundings

/// Measures on a sample of the points.
struct Measures {
  std::array<double, kCounts.size()> thickness, width, reach;  ///< medians
  double exact = 0.0;  ///< share of the points on plane faces

  bool along_lines(std::size_t count) const {
    return width[count] < kNarrow || reach[count] > kLinear;
  }
};

Measures measure(std::span<const Vec3> points, const spatial::NeighbourSearch& search) {
  const std::size_t samples = std::min<std::size_t>(points.size(), 2000);
  using OfSamples = std::array<std::vector<double>, kCounts.size()>;
  OfSamples thickness, width, reach;
  for (OfSamples* measure : {&thickness, &width, &reach}) {
    measure->fill(std::vector<double>(samples));
  }
  std::vector<std::uint8_t> is_exact(samples);
  parallel_blocks(samples, 100, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t s = begin; s < end; ++s) {
      chosen.push_back(static_cast<std::uint32_t>(s * points.size() / samples));
    }
    std::vector<spatial::Neighbour> found(chosen.size() * kCounts.back());
    search.nearest_others(chosen, kCounts.back(), found);
    std::vector<PlaneFit> fits(chosen.size());
    for (std::size_t c = 0; c < kCounts.size(); ++c) {
      std::vector<std::uint32_t> neighbours;
      for (std::size_t row = 0; row < found.size(); row += kCounts.back()) {
        for (std::size_t k = 0; k < kCounts[c]; ++k) neighbours.push_back(found[row + k].index);
      }
      fit_planes(points, chosen, neighbours, fits);
      for (std::size_t i = 0; i < fits.size(); ++i) {
        thickness[c][begin + i] = fits[i].thickness;
        width[c][begin + i] = fits[i].width;
        const auto near = std::span(found).subspan(i * kCounts.back(), kCounts[c]);
        const double quarter = near[kCounts[c] / 4 - 1].sq_distance;  // 0 if it is below 1e-154
        reach[c][begin + i] = quarter > 0.0 ? std::sqrt(near.back().sq_distance / quarter) : 0.0;
        if (kCounts[c] != kCounts.back()) continue;
        const auto row = std::span(neighbours).subspan(i * kCounts[c], kCounts[c]);
        is_exact[begin + i] = is_on_face(points, chosen[i], row);
      }
    }
  });
  const auto medians = [](const OfSamples& measure) {
    std::array<double, kCounts.size()> found;
    std::transform(measure.begin(), measure.end(), found.begin(),
                   [](const std::vector<double>& of_count) { return upper_median(of_count); });
    return found;
  };
  const double exact = std::accumulate(is_exact.begin(), is_exact.end(), 0.0);
  return {medians(thickness), medians(width), medians(reach), exact / static_cast<double>(samples)};
}

}  // namespace

std::string number_of(const NeighbourChoice& choice) {
  return choice.fewest == 0 || choice.fewest >= choice.neighbours
             ? fmt::to_string(choice.neighbours)
             : fmt::format("{} to {}", choice.fewest, choice.neighbours);
}

std::optional<NeighbourChoice> given_neighbours(int neighbours) {
  if (neighbours == 0) return std::nullopt;
  if (neighbours >= 2) return NeighbourChoice{static_cast<std::size_t>(neighbours)};
  throw Error(
      ErrorKind::kUsage,
      fmt::format("normals need at least 2 neighbours, or 0 to choose; not {}", neighbours));
}

NeighbourChoice choose_neighbours(std::span<const Vec3> points,
                                  const spatial::NeighbourSearch& search, Counts counts) {
  if (points.size() <= kCounts.back()) return {};
  const Measures measures = measure(points, search);
  const std::array<double, kCounts.size()>& thickness = measures.thickness;
  std::size_t first = 0;
  while (first + 1 < kCounts.size() && measures.along_lines(first)) ++first;
  if (thickness[first] <= kClean) return {.neighbours = kCounts[first]};
  const bool exact_planes = first == 0 && measures.exact >= kExactShare;
  const bool balls = thickness[first] >= kBall && !exact_planes;
  const auto least = std::min_element(thickness.begin() + first, thickness.end());
  const auto best = balls ? kCounts.size() - 1
                          : static_cast<std::size_t>(std::distance(thickness.begin(), least));
  NeighbourChoice choice = {kCounts[best], 0, balls || best > first, exact_planes};
  if (choice.noisy && counts == Counts::kLocal && points.size() >= kFew) {
    choice.neighbours = kCounts.back();
    choice.fewest = kCounts[first];
  }
  return choice;
}

}  // namespace pcednet::normals
