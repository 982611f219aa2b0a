#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/estimate.h"
#include "pcednet/normals/orient.h"

namespace pcednet::normals {

struct PrepareOptions {
  int neighbours = EstimateOptions{}.neighbours;  ///< for estimation and for orientation
  std::optional<Vec3> viewpoint = {};             ///< as in OrientOptions
  bool count_turned = false;                      ///< as in OrientOptions
  std::span<const std::uint32_t> curve = {};  ///< spatial::curve_order() of the positions, if known
  bool exact_planes = false;                  ///< as in EstimateOptions
};

struct PreparedNormals {
  std::vector<Vec3> normals;   ///< per position; (0,0,0) where there is none
  std::size_t unusable = 0;    ///< the number of (0,0,0)
  std::size_t estimated = 0;   ///< the number estimated that are not (0,0,0)
  std::size_t neighbours = 0;  ///< of each point, given or chosen
  bool exact_planes = false;   ///< likewise, see NeighbourChoice
  Orientation orientation;
};

/// estimate_normals() and orient_normals() with a single neighbour search.
PreparedNormals estimate_oriented_normals(std::span<const Vec3> positions,
                                          const PrepareOptions& options = {},
                                          const Progress* progress = nullptr);

/// Orients the `given` normals, one per position and of unit length, after estimating those that
/// are (0,0,0).
PreparedNormals complete_and_orient_normals(std::span<const Vec3> positions,
                                            std::span<const Vec3> given,
                                            const PrepareOptions& options = {},
                                            const Progress* progress = nullptr);

}  // namespace pcednet::normals
