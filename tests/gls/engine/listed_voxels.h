#pragma once

#include <vector>

#include "pcednet/gls/engine/voxels.h"

namespace pcednet::gls {

inline std::vector<Voxel> listed(VoxelSpan voxels) {
  std::vector<Voxel> list;
  for (std::size_t i = 0; i < voxels.size(); ++i) list.push_back(voxels[i]);
  return list;
}

}  // namespace pcednet::gls
