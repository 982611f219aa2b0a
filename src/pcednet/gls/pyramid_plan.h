#pragma once

#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// What becomes of blocks of 8 x 8 x 8 cells that are filled with normals of every direction
/// (leaves, noise), of which a neighbourhood holds ten times as many voxels as of a surface.
enum class Crowd {
  kKeep,         ///< nothing: they are voxels as elsewhere
  kMerge,        ///< 3 x 3 x 3 voxels, fewer to a neighbourhood than a surface has
  kMergeByAxis,  ///< one per 4 x 4 x 4 cells, axis and sign: for a gate, which looks at directions
};

/// What all points of a cloud together decide of its voxels. A part of the cloud that is described
/// with the plan of the whole has, away from its rim, the voxels of the whole.
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
