#include "pcednet/spatial/curve_order.h"

#include <algorithm>

#include "pcednet/cloud/bounding_box.h"

namespace pcednet::spatial {
namespace {

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

/// Spreads the lowest 21 bits so that two zero bits follow each of them.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

}  // namespace

std::vector<std::uint32_t> curve_order(std::span<const Vec3> positions) {
  const BoundingBox box = bounding_box(positions);
  const double side = box.empty() ? 0.0 : (box.max - box.min).maxCoeff();
  const double cells = side > 0.0 ? 2097151.0 / side : 0.0;

  std::vector<Keyed> keyed;
  keyed.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite()) continue;
    const Vec3 cell = (positions[i] - box.min) * cells;
    const auto bits = [&](int axis) { return spread_bits(static_cast<std::uint64_t>(cell[axis])); };
    keyed.push_back({bits(0) << 2 | bits(1) << 1 | bits(2), static_cast<std::uint32_t>(i)});
  }
  std::sort(keyed.begin(), keyed.end(), [&](const Keyed& a, const Keyed& b) {
    if (a.key != b.key) return a.key < b.key;
    const Vec3 &p = positions[a.index], &q = positions[b.index];
    if (p != q) return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
    return a.index < b.index;
  });

  std::vector<std::uint32_t> order(keyed.size());
  std::transform(keyed.begin(), keyed.end(), order.begin(), [](const Keyed& k) { return k.index; });
  return order;
}

}  // namespace pcednet::spatial
