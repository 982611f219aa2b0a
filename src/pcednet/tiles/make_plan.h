#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/model.h"
#include "pcednet/tiles/plan.h"
#include "pcednet/tiles/sort_inputs.h"

namespace pcednet::tiles {

struct PlanRequest {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path folder;  ///< for the tiles
  std::string output;            ///< names of the tiles, see lay_out(); empty: by the inputs
  PlannedModel model;            ///< its digest is computed here
  double tile_length = 0.0;      ///< 0: the largest that `memory` allows
  std::uint64_t memory = std::uint64_t{2} << 30;  ///< bytes allowed for one tile
  bool keep_orientation = false;
  std::optional<Vec3> viewpoint = {};  ///< of the scanner that saw all points
  SortRequest sort = {};
  std::string sort_name = {};  ///< what a user calls `sort`, for messages; empty: not offered
};

/// Plans the tiles of the inputs in memory that does not grow with them; reads large inputs twice.
/// `model` is the one that the request names, with the given bounds of the scales.
///
/// Inputs whose points are not in spatial order are rejected, after the first reading if that shows
/// it, or get a note where the tiles read them fewer times, unless there is a folder for copies.
/// Throws Error(kUnreadable) for inputs that cannot be read, Error(kUsage) for inputs that do not
/// fit together, for one that is there twice, and for a tile or copy with the name of an input,
/// Error(kInsufficient) if there is no finite point or no range of scales.
Plan make_plan(const PlanRequest& request, const detect::EdgeModel& model,
               const Progress* progress = nullptr);

}  // namespace pcednet::tiles
