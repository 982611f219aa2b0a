#include "pcednet/normals/flat_pairs.h"

#include <algorithm>
#include <cmath>

#include "pcednet/core/parallel.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kSample = 20000;
constexpr std::size_t kNeighbours = 12;
constexpr std::size_t kBlock = 1024;
constexpr double kParallel = 0.9;
constexpr double kLevel = 0.3;

bool is_usable(const Vec3& normal) {
  return normal.allFinite() && !normal.isZero(0.0);
}

}  // namespace

FlatPairs::FlatPairs(std::span<const Vec3> positions, std::span<const Vec3> normals) {
  std::vector<std::uint32_t> order = spatial::curve_order(positions);
  std::erase_if(order, [&](std::uint32_t i) { return !is_usable(normals[i]); });
  std::vector<Vec3> points(order.size());
  parallel_blocks(points.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = positions[order[i]];
  });
  const spatial::NeighbourSearch search(points);
  const std::size_t count = search.available(kNeighbours);
  const std::size_t samples = std::min(points.size(), kSample);
  std::vector<decltype(pairs_)> blocks((samples + kBlock - 1) / kBlock);
  parallel_blocks(samples, kBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t s = begin; s < end; ++s) {
      chosen.push_back(static_cast<std::uint32_t>(s * points.size() / samples));
    }
    std::vector<spatial::Neighbour> found(chosen.size() * count);
    search.nearest_others(chosen, kNeighbours, found);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::uint32_t i = chosen[k / count], j = found[k].index;
      const Vec3 &n = normals[order[i]], e = points[j] - points[i];
      const double rise = e.dot(n);
      const bool flat = std::abs(n.dot(normals[order[j]])) > kParallel &&
                        rise * rise < kLevel * kLevel * found[k].sq_distance;
      if (flat) blocks[begin / kBlock].emplace_back(order[i], order[j]);
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
