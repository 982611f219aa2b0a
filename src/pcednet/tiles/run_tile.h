#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// The points of a tile, and those around it that decide on them.
struct TileCloud {
  PointCloud core;  ///< with all columns, and what the output has beside points
  PointCloud all;   ///< the core and its buffer: positions, normals, scanners; the core first
  std::vector<std::uint64_t> numbers;  ///< of the core's points in all inputs, one after the other
};

/// What was found of the points of a core.
struct TileFindings {
  detect::PreparedCloud prepared;  ///< without the cloud it was made of: what was `made`
  detect::Classification found;
};

/// Reads of the inputs only the chunks that the tile meets. Throws Error(kUnreadable) where an
/// input is missing or has changed since the plan, Error(kFailure) where points are not those
/// planned.
TileCloud read_tile(const Plan& plan, std::size_t tile, const Progress* progress = nullptr);

/// The model of a plan, used as planned. Throws Error(kModelMismatch) if the file is another.
detect::EdgeModel load_planned_model(const Plan& plan);

/// Classifies the core of a tile; without a model only makes its normals. Leaves `points.all`
/// empty.
TileFindings classify_tile(const Plan& plan, std::size_t tile, const detect::EdgeModel* model,
                           TileCloud& points, const Progress* progress = nullptr);

/// Classifies a tile and writes it, then its record. Whoever else does the same at the same time
/// writes the same bytes. Throws what read_tile() throws, and Error(kFailure) for a full disk.
void run_tile(const Plan& plan, std::size_t tile, const detect::EdgeModel& model,
              const Progress* progress = nullptr);

}  // namespace pcednet::tiles
