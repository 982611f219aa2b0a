#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "workbench/shapes/solids/solid_samples.h"

namespace pcednet::shapes {

/// The distribution of mesh vertices on a CAD part.
struct MeshStyle {
  std::size_t points = 10000;   ///< approximate number
  double plane_growth = 0.3;    ///< growth of the spacing on planes per distance to the next border
  double plane_limit = 4.0;     ///< largest spacing on planes over that at borders
  double curved_spacing = 1.0;  ///< spacing on curved faces over that at borders
  bool smooth_borders = true;   ///< also on borders where faces join smoothly
};

struct MeshVertices {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit; on a border the mean of both faces
  std::vector<std::uint8_t> labels;
};

/// The smallest angle between the normals at a sharp edge: 25 degrees.
inline constexpr double kSharpTurn = 25.0 * 3.14159265358979 / 180.0;

/// Vertices evenly spaced along the borders, exactly on them, and scattered over the faces with a
/// spacing that grows away from borders. Those on sharp borders are sharp-edge, all others
/// non-edge.
MeshVertices mesh_vertices(const SolidSamples& samples, std::span<const BorderPoint> borders,
                           const Solid& solid, const MeshStyle& style, std::uint64_t seed);

}  // namespace pcednet::shapes
