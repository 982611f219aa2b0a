#include "pcednet/normals/neighbour_count.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::normals {
namespace {

constexpr std::array<std::size_t, 3> kCounts = {12, 24, 48};

}  // namespace

std::size_t choose_neighbour_count(std::span<const Vec3> points,
                                   const spatial::NeighbourSearch& search) {
  if (points.size() <= kCounts.back()) return kCounts.front();
  const std::size_t samples = std::min<std::size_t>(points.size(), 2000);
  std::array<std::vector<double>, kCounts.size()> thickness;
  for (std::vector<double>& of_count : thickness) of_count.resize(samples);
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
      for (std::size_t i = 0; i < fits.size(); ++i) thickness[c][begin + i] = fits[i].thickness;
    }
  });
  double thinnest = upper_median(thickness[0]);
  if (thinnest <= 0.01) return kCounts[0];
  std::size_t chosen = 0;
  for (std::size_t c = 1; c < kCounts.size(); ++c) {
    const double wider = upper_median(thickness[c]);
    if (wider >= thinnest) break;
    thinnest = wider;
    chosen = c;
  }
  return kCounts[chosen];
}

}  // namespace pcednet::normals
