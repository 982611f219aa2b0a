#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "pcednet/core/progress.h"
#include "pcednet/core/scratch_file.h"
#include "pcednet/tiles/plan.h"
#include "pcednet/tiles/run_tile.h"

namespace pcednet::tiles {

/// What was found of every point, in the order of the inputs: on disk, in a file without a name.
class PointLabels {
 public:
  /// On the disk of `beside`. `normals`: whether there are some that were made.
  PointLabels(const std::filesystem::path& beside, bool normals);

  /// Keeps the findings of the points of these numbers.
  void put(std::span<const std::uint64_t> numbers, const TileFindings& findings);

  /// The findings of the points [begin, end), all of which were put.
  TileFindings get(std::size_t begin, std::size_t end) const;

 private:
  std::size_t stride_;
  ScratchFile file_;
};

/// Classifies all points tile after tile, in the memory of one, and counts what was found; without
/// a model only makes their normals. Throws what read_tile() throws, and Error(kFailure) for a full
/// disk.
detect::ClassCounts label_points(const Plan& plan, const detect::EdgeModel* model,
                                 PointLabels& labels, const Progress* progress = nullptr);

}  // namespace pcednet::tiles
