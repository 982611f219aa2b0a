#include "pcednet/cloud/bounding_box.h"

namespace pcednet {

BoundingBox bounding_box(std::span<const Vec3> positions) {
  BoundingBox box;
  for (const Vec3& position : positions) {
    if (!position.allFinite()) continue;
    box.min = box.min.cwiseMin(position);
    box.max = box.max.cwiseMax(position);
  }
  return box;
}

}  // namespace pcednet
