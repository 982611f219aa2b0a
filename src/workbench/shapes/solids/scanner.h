#pragma once

#include <cstdint>
#include <vector>

#include "workbench/shapes/solids/scene.h"
#include "workbench/shapes/solids/solid_samples.h"

namespace pcednet::shapes {

struct ScannerOptions {
  std::size_t rays = 20000;    ///< per scanner position, at equal angles; 4 or more
  double range = 15.0;         ///< largest distance of a return
  double range_noise = 0.003;  ///< standard deviation along the ray
  double mixed = 0.1;          ///< probability of a mixed point where a ray grazes an edge
  double outliers = 0.001;     ///< share of points at a random distance along their ray
  double misalignment = 0.0;   ///< standard deviation of the registration error between scans
  std::size_t places = 1;
};

/// The kind of surface that a ray hit. Strays are mixed points, between near and far, and outliers.
enum class ReturnKind : std::uint8_t { kSolid, kLeaf, kStray };

/// The laser scan of a scene. Hidden surfaces have no points; far and slanted ones have few.
struct Scan {
  std::vector<Vec3> positions;
  std::vector<ReturnKind> kinds;
  std::vector<std::uint8_t> places;  ///< index into Scene::scanners
  /// The direction, of any length, in which the scanner sees no more of the surface beside the
  /// point: it is hidden, out of reach, or turns away. 0 where it sees more all around.
  std::vector<Vec3> open_sides;
};

Scan scan_scene(const Scene& scene, const ScannerOptions& options, std::uint64_t seed);

}  // namespace pcednet::shapes
