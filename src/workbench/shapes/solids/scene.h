#pragma once

#include <vector>

#include "pcednet/core/random.h"
#include "workbench/shapes/solids/solid.h"

namespace pcednet::shapes {

/// A position for a scanner.
struct ScanPlace {
  Vec3 position;
  Vec3 towards;  ///< the point it faces
};

/// A scene about ten units (metres) large.
struct Scene {
  Solid solid = {};
  std::vector<Vec3> foliage;        ///< positions of leaves
  std::vector<ScanPlace> scanners;  ///< good positions, best first
};

/// The kinds of random_scene(): a facade, a yard with steps and pipes, a room, a monument.
inline constexpr int kSceneKinds = 4;
const char* scene_kind_name(int kind);

Scene random_scene(int kind, Random& random);

}  // namespace pcednet::shapes
