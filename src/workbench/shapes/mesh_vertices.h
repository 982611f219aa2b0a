#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "workbench/shapes/solid_samples.h"

namespace pcednet::shapes {

/// How the vertices of a CAD program's mesh lie on a part.
struct MeshStyle {
  std::size_t points = 10000;  ///< about as many
  double plane_growth =
      0.3;  ///< by how much of the distance to the next border spacing grows on planes
  double plane_limit = 4.0;     ///< to at most so many times that at borders
  double curved_spacing = 1.0;  ///< on curved faces, times that at borders
  bool smooth_borders = true;   ///< vertices on the borders where faces join smoothly, too
};

struct MeshVertices {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit; on a border the mean of the faces'
  std::vector<std::uint8_t> labels;
};

/// The turn from which on a border is a sharp edge: 25 degrees.
inline constexpr double kSharpTurn = 25.0 * 3.14159265358979 / 180.0;

/// Vertices evenly spaced along the borders, exactly on them, and scattered over the faces at
/// growing distances. Those on borders that turn are sharp-edge, all others non-edge.
MeshVertices mesh_vertices(const SolidSamples& samples, std::span<const BorderPoint> borders,
                           const Solid& solid, const MeshStyle& style, std::uint64_t seed);

}  // namespace pcednet::shapes
