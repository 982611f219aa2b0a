#include "pcednet/cloud/bounding_box.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"

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

}  // namespace pcednet
