#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// A cloud, and what its reader has to tell the user about it.
struct LoadedCloud {
  PointCloud cloud;
  std::vector<std::string> warnings;
  std::size_t rescaled_normals = 0;  ///< usable ones whose length in the file was not 1 +- 0.001
};

}  // namespace pcednet::io
