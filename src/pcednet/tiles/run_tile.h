#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// The points of a tile, and those around it that affect its results.
struct TileCloud {
  PointCloud core;  ///< with all columns, and the output's content beside points
  PointCloud all;   ///< the core and its buffer: positions, normals, scanners; the core first
  std::vector<std::uint64_t> numbers;  ///< of the core's points, counted through all inputs
};

/// The findings for the points of a core.
struct TileFindings {
  std::vector<Vec3> made = {};  ///< as in detect::PreparedCloud
  detect::Classification found = {};
};

/// Reads only the chunks of the inputs that the tile intersects. Throws Error(kUnreadable) where an
/// input is missing or has changed since the plan, Error(kFailure) where points are not those
/// planned.
TileCloud read_tile(const Plan& plan, std::size_t tile, const Progress* progress = nullptr);

/// The model of a plan, used as planned. Throws Error(kModelMismatch) if the file is another,
/// Error(kUnreadable) for decisions on voxels that no plan with this model has.
detect::EdgeModel load_planned_model(const Plan& plan);

/// Classifies the core of a tile; without a model only makes its normals. Leaves `points.all`
/// empty.
TileFindings classify_tile(const Plan& plan, std::size_t tile, const detect::EdgeModel* model,
                           TileCloud& points, const Progress* progress = nullptr);

/// Classifies a tile and writes it, then its record. Concurrent runs of the same tile write the
/// same bytes. Throws as read_tile() does, and Error(kFailure) for a full disk.
void run_tile(const Plan& plan, std::size_t tile, const detect::EdgeModel& model,
              const Progress* progress = nullptr);

}  // namespace pcednet::tiles
