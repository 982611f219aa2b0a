#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pcednet/gls/descriptor.h"
#include "pcednet/gls/engine/voxel_pyramid.h"

namespace pcednet::gls {

/// One evaluation point that single precision could not settle.
struct DoubtfulTarget {
  Vec3 position;               ///< of the point
  Vec3 offset;                 ///< from it to the evaluation point
  Vec3 normal;                 ///< of the point, for the gate; zero: the gate is open
  double t;                    ///< support radius
  std::optional<double> gate;  ///< threshold of side_gate()
};

struct RecheckedFit {
  SphereFit fit;
  Descriptor descriptor;
};

/// The status that the number of neighbours gives, among the voxels numbered `candidates`.
FitStatus recheck_status(const DoubtfulTarget& target, const VoxelLevel& level,
                         std::span<const std::uint32_t> candidates);

/// The fit and its description in double precision.
RecheckedFit recheck_fit(const DoubtfulTarget& target, const VoxelLevel& level,
                         std::span<const std::uint32_t> candidates);

}  // namespace pcednet::gls
