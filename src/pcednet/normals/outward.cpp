#include "pcednet/normals/outward.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/core/vector_clones.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kDirections = 48;
constexpr std::size_t kMembersAtOnce = 1024;

/// The permutations of (+-1, +-2, +-3): well spread, and along none of the axes and diagonals that
/// are common in parts and buildings.
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

/// One number per direction.
using Heights = std::array<double, kDirections>;

struct Ends {
  Heights lowest, highest;
};

PCEDNET_VECTOR_CLONES
void measure(const Heights (&directions)[3], const Vec3& origin, std::span<const Vec3> points,
             std::span<const std::uint32_t> members, Ends& ends) {
  const double *const dx = directions[0].data(), *const dy = directions[1].data(),
                      *const dz = directions[2].data();
  double* const lowest = ends.lowest.data();
  double* const highest = ends.highest.data();
  for (const std::uint32_t i : members) {
    const double* const p = points[i].data();
    const double x = p[0] - origin.x(), y = p[1] - origin.y(), z = p[2] - origin.z();
    for (std::size_t k = 0; k < kDirections; ++k) {
      const double height = dx[k] * x + dy[k] * y + dz[k] * z;
      lowest[k] = height < lowest[k] ? height : lowest[k];
      highest[k] = height > highest[k] ? height : highest[k];
    }
  }
}

/// The ends of every block of members, from the first member.
std::vector<Ends> measure_blocks(const std::array<Vec3, kDirections>& all,
                                 std::span<const Vec3> points,
                                 std::span<const std::uint32_t> members) {
  Heights directions[3];
  for (std::size_t k = 0; k < kDirections; ++k) {
    for (int a = 0; a < 3; ++a) directions[a][k] = all[k][a];
  }
  Ends none;
  none.lowest.fill(std::numeric_limits<double>::infinity());
  none.highest.fill(-std::numeric_limits<double>::infinity());
  std::vector<Ends> blocks((members.size() + kMembersAtOnce - 1) / kMembersAtOnce, none);
  parallel_blocks(members.size(), kMembersAtOnce, [&](std::size_t begin, std::size_t end) {
    measure(directions, points[members.front()], points, members.subspan(begin, end - begin),
            blocks[begin / kMembersAtOnce]);
  });
  return blocks;
}

/// The mean of n.d over the members at the far end in direction `k`.
double mean_at_far_end(std::span<const Vec3> points, std::span<const Vec3> normals,
                       std::span<const std::uint32_t> members, const std::vector<Ends>& blocks,
                       const Vec3& direction, std::size_t k) {
  const Vec3& origin = points[members.front()];
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const Ends& ends : blocks) {
    lowest = std::min(lowest, ends.lowest[k]);
    highest = std::max(highest, ends.highest[k]);
  }
  const double bound = highest - 0.02 * (highest - lowest);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    if (blocks[block].highest[k] < bound) continue;
    const std::size_t begin = block * kMembersAtOnce,
                      end = std::min(members.size(), begin + kMembersAtOnce);
    for (const std::uint32_t i : members.subspan(begin, end - begin)) {
      const Vec3 p = points[i] - origin;
      if (direction[0] * p[0] + direction[1] * p[1] + direction[2] * p[2] < bound) continue;
      sum += direction.dot(normals[i]);
      ++count;
    }
  }
  return sum / static_cast<double>(count);
}

}  // namespace

double outwardness(std::span<const Vec3> points, std::span<const Vec3> normals,
                   std::span<const std::uint32_t> members) {
  if (members.empty()) return 0.0;
  const auto all = directions();
  const std::vector<Ends> blocks = measure_blocks(all, points, members);
  Heights means;
  // Small surfaces are numerous, and not worth a thread each.
  parallel_blocks(kDirections, members.size() < 1000 ? kDirections : 1,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t k = begin; k < end; ++k) {
                      means[k] = mean_at_far_end(points, normals, members, blocks, all[k], k);
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
