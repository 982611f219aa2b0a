#include "pcednet/normals/flat_pairs.h"

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kSample = 20000;
constexpr std::size_t kNeighbours = 12;
constexpr std::size_t kPairsAtOnce = 1024;
constexpr double kParallel = 0.9;
constexpr double kLevel = 0.3;

}  // namespace

FlatPairs::FlatPairs(std::span<const Vec3> positions, std::span<const Vec3> normals,
                     std::span<const std::uint32_t> curve) {
  std::vector<std::uint32_t> order(curve.begin(), curve.end());
  std::erase_if(order, [&](std::uint32_t i) { return !is_usable(normals[i]); });
  const std::vector<Vec3> points = spatial::in_order(positions, order);
  const spatial::NeighbourSearch search(points);
  const std::size_t count = search.available(kNeighbours);
  const std::size_t samples = std::min(points.size(), kSample);
  std::vector<decltype(pairs_)> blocks((samples + kPairsAtOnce - 1) / kPairsAtOnce);
  parallel_blocks(samples, kPairsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t s = begin; s < end; ++s) {
      chosen.push_back(static_cast<std::uint32_t>(s * points.size() / samples));
    }
    std::vector<spatial::Neighbour> found(chosen.size() * count);
    search.nearest_others(chosen, kNeighbours, found);
    auto& pairs = blocks[begin / kPairsAtOnce];
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      const std::uint32_t i = chosen[c];
      const Vec3& n = normals[order[i]];
      const std::size_t before = pairs.size();
      for (const spatial::Neighbour& other : std::span(found).subspan(c * count, count)) {
        const double rise = (points[other.index] - points[i]).dot(n);
        const bool flat = std::abs(n.dot(normals[order[other.index]])) > kParallel &&
                          rise * rise < kLevel * kLevel * other.sq_distance;
        if (flat) pairs.emplace_back(order[i], order[other.index]);
      }
      if (2 * (pairs.size() - before) <= count) pairs.resize(before);  // among leaves or noise
    }
  });
  for (const auto& block : blocks) pairs_.insert(pairs_.end(), block.begin(), block.end());
}

std::size_t FlatPairs::opposed(std::span<const Vec3> normals) const {
  return static_cast<std::size_t>(std::count_if(pairs_.begin(), pairs_.end(), [&](const auto& p) {
    return normals[p.first].dot(normals[p.second]) < 0.0;
  }));
}

double FlatPairs::one_sidedness(std::span<const Vec3> positions,
                                std::span<const Vec3> normals) const {
  double sum = 0.0, sizes = 0.0;
  for (const auto& [i, j] : pairs_) {
    if (normals[i].dot(normals[j]) >= 0.0) continue;
    const double rise = (positions[j] - positions[i]).normalized().dot(normals[i]);
    sum += rise, sizes += std::abs(rise);
  }
  return sizes > 0.0 ? std::abs(sum) / sizes : 0.0;
}

}  // namespace pcednet::normals
