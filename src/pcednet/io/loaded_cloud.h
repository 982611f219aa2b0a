#pragma once

#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// A cloud, and what its reader has to tell the user about it.
struct LoadedCloud {
  PointCloud cloud;
  std::vector<std::string> warnings;
};

}  // namespace pcednet::io
