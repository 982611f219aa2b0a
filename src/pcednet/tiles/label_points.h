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

/// The findings of every point, in the order of the inputs: on disk, in an unnamed file.
class PointLabels {
 public:
  /// On the disk of `beside`. `own_classes`: whether the model has some; `normals`: whether some
  /// are estimated.
  PointLabels(const std::filesystem::path& beside, bool own_classes, bool normals);

  /// Keeps the findings of the points of these numbers.
  void put(std::span<const std::uint64_t> numbers, const TileFindings& findings);

  /// The findings of the points [begin, end), all of which were put.
  TileFindings get(std::size_t begin, std::size_t end) const;

 private:
  bool own_classes_, normals_;
  ScratchFile file_;
};

/// Classifies all points tile by tile, in the memory of one tile; without a model only makes their
/// normals. Returns what is true of the cloud as a whole, without its points: counts, scales, and
/// the expert if the same one decided in all tiles. Throws as read_tile() does, and Error(kFailure)
/// for a full disk.
detect::Classification label_points(const Plan& plan, const detect::EdgeModel* model,
                                    PointLabels& labels, const Progress* progress = nullptr);

}  // namespace pcednet::tiles
