#include "pcednet/normals/outward.h"

#include <array>
#include <cmath>
#include <limits>

#include "pcednet/core/parallel.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kDirections = 48;

/// The permutations of (+-1, +-2, +-3): well spread, and along none of the axes and diagonals that
/// the faces of parts and buildings like.
std::array<Vec3, kDirections> directions() {
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  std::array<Vec3, kDirections> all;
  for (std::size_t k = 0; k < kDirections; ++k) {
    Vec3& direction = all[k];
    for (int a = 0; a < 3; ++a) direction[kOrders[k / 8][a]] = (k >> a & 1) != 0 ? -(a + 1) : a + 1;
    direction.normalize();
  }
  return all;
}

double mean_at_far_end(std::span<const Vec3> points, std::span<const Vec3> normals,
                       std::span<const std::uint32_t> members, const Vec3& direction) {
  const Vec3 origin = points[members.front()];
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const std::uint32_t i : members) {
    const double height = direction.dot(points[i] - origin);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  const double bound = highest - 0.02 * (highest - lowest);
  double sum = 0.0;
  std::size_t count = 0;
  for (const std::uint32_t i : members) {
    if (direction.dot(points[i] - origin) < bound) continue;
    sum += direction.dot(normals[i]);
    ++count;
  }
  return sum / static_cast<double>(count);
}

}  // namespace

double outwardness(std::span<const Vec3> points, std::span<const Vec3> normals,
                   std::span<const std::uint32_t> members) {
  if (members.empty()) return 0.0;
  const auto all = directions();
  std::array<double, kDirections> means;
  // Small surfaces are many, and not worth a thread each.
  parallel_blocks(kDirections, members.size() < 1000 ? kDirections : 1,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t k = begin; k < end; ++k) {
                      means[k] = mean_at_far_end(points, normals, members, all[k]);
                    }
                  });
  double sum = 0.0, sizes = 0.0;
  for (const double mean : means) {
    sum += mean;
    sizes += std::abs(mean);
  }
  return sizes > 0.0 ? sum / sizes : 0.0;
}

}  // namespace pcednet::normals
