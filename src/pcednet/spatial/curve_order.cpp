#include "pcednet/spatial/curve_order.h"

#include <algorithm>
#include <limits>
#include <string>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/core/prefetch.h"
#include "pcednet/core/unset_array.h"
#include "pcednet/spatial/morton.h"
#include "pcednet/spatial/radix_sort.h"

namespace pcednet::spatial {
namespace {

constexpr int kBits = 21;
constexpr double kCells = (1 << kBits) - 1;
constexpr std::size_t kCodesAtOnce = 1 << 14;
/// Indices have 32 bits, and the largest often stands for no point.
constexpr std::size_t kMostPoints = std::numeric_limits<std::uint32_t>::max() - std::size_t{1};
constexpr std::size_t kFew = 64;  // up to this many are compared instead of getting finer keys

/// Half the lower corner and half the longest side of the box (halves do not overflow).
std::pair<Vec3, double> half_box(std::span<const Vec3> positions, std::span<const Keyed> keyed) {
  std::vector<BoundingBox> boxes((keyed.size() + kCodesAtOnce - 1) / kCodesAtOnce);
  parallel_blocks(keyed.size(), kCodesAtOnce, [&](std::size_t begin, std::size_t end) {
    BoundingBox box;
    for (std::size_t i = begin; i < end; ++i) box.add(positions[keyed[i].index]);
    boxes[begin / kCodesAtOnce] = box;
  });
  BoundingBox box;
  for (const BoundingBox& one : boxes) box.add(one);
  return {0.5 * box.min, (0.5 * box.max - 0.5 * box.min).maxCoeff()};
}

/// Sorts points, given in the order of their indices, along the curve through their box. Those that
/// share a cell are sorted along the curve through theirs: points far from all others cost the
/// others nothing.
void sort_along_curve(std::span<const Vec3> positions, std::span<Keyed> keyed) {
  if (keyed.size() <= 1) return;
  if (keyed.size() <= kFew) {
    std::stable_sort(keyed.begin(), keyed.end(), [&](const Keyed& a, const Keyed& b) {
      return is_before(positions[a.index], positions[b.index]);
    });
    return;
  }
  const auto [min, side] = half_box(positions, keyed);
  if (!(side > 0.0)) return;
  parallel_blocks(keyed.size(), kCodesAtOnce, [&, min = min, side = side](auto begin, auto end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 cell = (0.5 * positions[keyed[i].index] - min) / side * kCells;
      keyed[i].key =
          morton_code({static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                       static_cast<std::uint32_t>(cell.z())});
    }
  });
  sort_by_key(keyed, 3 * kBits);
  for (auto first = keyed.begin(); first != keyed.end();) {
    const auto last =
        std::find_if(first + 1, keyed.end(), [&](const Keyed& k) { return k.key != first->key; });
    if (last - first > 1) sort_along_curve(positions, {first, last});
    first = last;
  }
}

/// Whether the i-th point of the order lies where the one before it does.
bool is_copy(std::span<const Vec3> positions, std::span<const std::uint32_t> order, std::size_t i) {
  return i > 0 && positions[order[i]] == positions[order[i - 1]];
}

/// counts_before_blocks() of these.
std::vector<std::size_t> count_copies(std::span<const Vec3> positions,
                                      std::span<const std::uint32_t> order) {
  return counts_before_blocks(order.size(), kCodesAtOnce, [&](std::size_t i) {
    if (i + kAskAhead < order.size()) prefetch(positions[order[i + kAskAhead]]);
    return is_copy(positions, order, i);
  });
}

}  // namespace

std::vector<std::uint32_t> curve_order(std::span<const Vec3> positions) {
  if (positions.size() > kMostPoints) {
    throw Error(ErrorKind::kFailure, std::to_string(positions.size()) +
                                         " points: in one piece at most 2^32 - 2 are possible");
  }
  const auto finite = counts_before_blocks(positions.size(), kCodesAtOnce,
                                           [&](std::size_t i) { return positions[i].allFinite(); });
  UnsetArray<Keyed> keyed(finite.back());
  parallel_blocks(positions.size(), kCodesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::size_t to = finite[begin / kCodesAtOnce];
    for (std::size_t i = begin; i < end; ++i) {
      if (positions[i].allFinite()) keyed[to++] = {0, static_cast<std::uint32_t>(i)};
    }
  });
  sort_along_curve(positions, keyed);
  std::vector<std::uint32_t> order(keyed.size());
  parallel_for_each(order.size(), [&](std::size_t i) { order[i] = keyed[i].index; });
  return order;
}

bool have_copies(std::span<const Vec3> positions, std::span<const std::uint32_t> order) {
  return count_copies(positions, order).back() > 0;
}

std::vector<std::uint32_t> firsts_of_places(std::span<const Vec3> positions,
                                            std::span<const std::uint32_t> order) {
  const std::vector<std::size_t> copies = count_copies(positions, order);
  std::vector<std::uint32_t> firsts(order.size() - copies.back());
  parallel_blocks(order.size(), kCodesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::size_t to = begin - copies[begin / kCodesAtOnce];
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_copy(positions, order, i)) firsts[to++] = order[i];
    }
  });
  return firsts;
}

std::vector<Vec3> in_order(std::span<const Vec3> positions, std::span<const std::uint32_t> order) {
  std::vector<Vec3> ordered(order.size());
  parallel_for_each(order.size(), [&](std::size_t i) { ordered[i] = positions[order[i]]; });
  return ordered;
}

}  // namespace pcednet::spatial
