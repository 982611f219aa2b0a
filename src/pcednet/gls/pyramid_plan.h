#pragma once

#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// The treatment of blocks of 8 x 8 x 8 cells full of normals in all directions (leaves, noise),
/// which give a neighbourhood ten times as many voxels as a surface does.
enum class Crowd {
  kKeep,         ///< voxels as elsewhere
  kMerge,        ///< 3 x 3 x 3 voxels per block, fewer per neighbourhood than on a surface
  kMergeByAxis,  ///< one voxel per 4 x 4 x 4 cells, axis and sign: for a gate, which depends on
                 ///< directions
};

/// The decisions on voxels that depend on all points of a cloud. A part described with the plan of
/// the whole has, away from its rim, the voxels of the whole.
struct PyramidPlan {
  Vec3 corner = Vec3::Zero();  ///< the lower corner of the cloud's box
  double side = 0.0;           ///< its longest side

  struct Level {
    bool merges = false;  ///< the scale has a level of its own
    Crowd crowd = Crowd::kKeep;
    bool operator==(const Level&) const = default;
  };
  std::vector<Level> levels = {};  ///< per scale
};

}  // namespace pcednet::gls
