#pragma once

#include <cstdint>
#include <vector>

#include "workbench/shapes/scene.h"
#include "workbench/shapes/solid_samples.h"

namespace pcednet::shapes {

struct ScannerOptions {
  std::size_t rays = 20000;    ///< per place, at equal angles
  double range = 15.0;         ///< beyond, nothing returns
  double range_noise = 0.003;  ///< standard deviation along the ray
  double mixed = 0.1;         ///< chance of a point between near and far where a ray grazes an edge
  double outliers = 0.001;    ///< share of points anywhere along their ray
  double misalignment = 0.0;  ///< how far scans from other places are shifted
  std::size_t places = 1;
};

/// What a ray came back from. Strays are mixed points, between near and far, and outliers.
enum class ReturnKind : std::uint8_t { kSolid, kLeaf, kStray };

/// What a laser scanner sees of a scene from its places: positions with the place each was seen
/// from. Surfaces behind others are not seen, far and slanted ones are sparse.
struct Scan {
  std::vector<Vec3> positions;
  std::vector<Vec3> origins;  ///< of the ray, per point
  std::vector<ReturnKind> kinds;
};

Scan scan_scene(const Scene& scene, const ScannerOptions& options, std::uint64_t seed);

}  // namespace pcednet::shapes
