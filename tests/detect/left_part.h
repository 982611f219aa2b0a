#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/detect/part_of_cloud.h"

namespace pcednet::detect {

/// The points of a cloud up to x, with their numbers in it, as a part of it.
struct LeftPart {
  PointCloud cloud = {};
  std::vector<std::uint32_t> numbers = {};
  PartOfCloud part = {};

  LeftPart(const PointCloud& whole, double x) {
    for (std::uint32_t i = 0; i < whole.size(); ++i) {
      if (whole.positions[i].x() > x) continue;
      cloud.positions.push_back(whole.positions[i]);
      cloud.normals.push_back(whole.normals[i]);
      numbers.push_back(i);
    }
    const BoundingBox box = bounding_box(whole.positions);
    part = {.pyramids = {{box.min, (box.max - box.min).maxCoeff(), {}}}, .points = whole.size()};
  }
};

}  // namespace pcednet::detect
