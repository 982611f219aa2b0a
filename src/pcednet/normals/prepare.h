#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/estimate.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/orient.h"

namespace pcednet::normals {

struct OrientedNormalsOptions {
  std::optional<NeighbourChoice> choice = {};  ///< for estimation and for orientation
  std::optional<Vec3> viewpoint = {};          ///< as in OrientOptions
  bool count_turned = false;                   ///< as in OrientOptions
  std::span<const std::uint32_t> curve = {};  ///< spatial::curve_order() of the positions, if known
};

struct PreparedNormals {
  std::vector<Vec3> normals;    ///< per position; (0,0,0) where there is none
  std::size_t unusable = 0;     ///< the number of (0,0,0)
  std::size_t estimated = 0;    ///< the number estimated that are not (0,0,0)
  NeighbourChoice choice = {};  ///< given or chosen
  Orientation orientation;
};

/// estimate_normals() and orient_normals() with a single neighbour search.
PreparedNormals estimate_oriented_normals(std::span<const Vec3> positions,
                                          const OrientedNormalsOptions& options = {},
                                          const Progress* progress = nullptr);

/// Orients the `given` normals, one per position and of unit length, after estimating those that
/// are (0,0,0).
PreparedNormals complete_and_orient_normals(std::span<const Vec3> positions,
                                            std::span<const Vec3> given,
                                            const OrientedNormalsOptions& options = {},
                                            const Progress* progress = nullptr);

}  // namespace pcednet::normals
