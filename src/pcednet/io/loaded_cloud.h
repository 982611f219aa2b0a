#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// A cloud, and its reader's warnings to the user.
struct LoadedCloud {
  PointCloud cloud;
  std::vector<std::string> warnings;
  std::size_t rescaled_normals =
      0;  ///< usable ones with a length other than 1 +- 0.001 in the file
};

}  // namespace pcednet::io
