#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::bench {

struct Cloud {
  std::vector<Vec3> positions, normals;

  void add(const Vec3& position, const Vec3& normal) {
    positions.push_back(position);
    normals.push_back(normal);
  }
};

/// A kind of benchmark cloud, and its description.
struct CloudKind {
  const char* name;
  const char* what;
  Cloud (*make)(std::size_t points);
};

/// The clean scene first, then a rough scan, then clouds that are hard for an engine that merges
/// points.
const std::vector<CloudKind>& cloud_kinds();

/// The cloud of that name: the same for the same name and number of points. Throws Error(kUsage)
/// for a name that is not among cloud_kinds().
Cloud make_cloud(std::string_view name, std::size_t points);

}  // namespace pcednet::bench
