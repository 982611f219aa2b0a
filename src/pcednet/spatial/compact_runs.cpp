#include "pcednet/spatial/compact_runs.h"

#include <algorithm>
#include <array>
#include <limits>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/parallel.h"

namespace pcednet::spatial {
namespace {

constexpr std::size_t kLongest = 1024;

double size_of(const BoundingBox& box) {
  return (box.max - box.min).sum();
}

/// Cuts where the two sides together are smallest, each point weighing as much as its side is wide,
/// until the runs are short enough. `left` is room for the costs of the runs that end before each
/// point.
void cut(std::span<const Vec3> points, std::size_t begin, std::size_t end, std::size_t most,
         std::array<double, kLongest>& left, std::vector<std::uint32_t>& first) {
  if (end - begin <= most) {
    first.push_back(static_cast<std::uint32_t>(begin));
    return;
  }
  BoundingBox box;
  for (std::size_t i = begin + 1; i < end; ++i) {
    box.add(points[i - 1]);
    left[i - begin] = static_cast<double>(i - begin) * size_of(box);
  }
  double least = std::numeric_limits<double>::infinity();
  std::size_t middle = begin + (end - begin) / 2;
  box = {};
  for (std::size_t i = end - 1; i > begin; --i) {
    box.add(points[i]);
    const double cost = left[i - begin] + static_cast<double>(end - i) * size_of(box);
    if (cost < least) least = cost, middle = i;
  }
  cut(points, begin, middle, most, left, first);
  cut(points, middle, end, most, left, first);
}

}  // namespace

std::vector<std::uint32_t> cut_compact_runs(std::span<const Vec3> points, std::size_t most) {
  std::vector<std::vector<std::uint32_t>> blocks((points.size() + kLongest - 1) / kLongest);
  parallel_blocks(points.size(), kLongest, [&](std::size_t begin, std::size_t end) {
    std::array<double, kLongest> left;
    cut(points, begin, end, most, left, blocks[begin / kLongest]);
  });
  std::vector<std::uint32_t> first;
  for (const auto& block : blocks) first.insert(first.end(), block.begin(), block.end());
  first.push_back(static_cast<std::uint32_t>(points.size()));
  return first;
}

}  // namespace pcednet::spatial
