#include "pcednet/cloud/bounding_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/median.h"

namespace pcednet {

void check_extent(std::span<const Vec3> positions) {
  constexpr double kMost = 1e150;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double largest = positions[i].cwiseAbs().maxCoeff();
    if (!positions[i].allFinite() || largest <= kMost) continue;
    throw Error(
        ErrorKind::kInsufficient,
        fmt::format("coordinates too large: {:.6g} at point {}; at most {:g}", largest, i, kMost));
  }
}

BoundingBox bounding_box(std::span<const Vec3> positions) {
  BoundingBox box;
  for (const Vec3& position : positions) {
    if (position.allFinite()) box.add(position);
  }
  return box;
}

BoundingBox box_of_most(std::span<const Vec3> places) {
  BoundingBox box;
  if (places.empty()) return box;
  std::vector<double> values(places.size());
  const std::size_t low = (places.size() - 1) / 50, high = places.size() - 1 - low;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(places, values.begin(), [&](const Vec3& p) { return p[axis]; });
    box.min[axis] = value_at_rank(values, low);
    box.max[axis] = value_at_rank(values, high);
  }
  const double margin = 2.0 * (box.max - box.min).maxCoeff();
  return {box.min.array() - margin, box.max.array() + margin};
}

}  // namespace pcednet
