#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/gls/engine/block.h"
#include "pcednet/gls/engine/lane_kernels.h"
#include "pcednet/gls/fit_status.h"

namespace pcednet::gls {

/// The points [begin, begin + count) of the pyramid's first level, at most kLanes of them.
struct LaneGroup {
  std::size_t begin, count;
};

/// The evaluation points of a group: its points, and where they have moved in a frame.
struct Group {
  VoxelSpan points;
  LaneTargets targets;
  SourceBox box;                                          ///< of the targets
  NormalBox normals;                                      ///< theirs
  std::array<std::array<float, 3>, kLanes> offsets = {};  ///< from the points, in t
};

/// The fits of a group of points at one scale.
struct GroupFit {
  std::array<FitStatus, kLanes> status;
  LaneFits fits = {};  ///< features are finite, and 0 where undefined
};

/// The threshold of side_gate(), or none.
using Gate = std::optional<double>;

/// The parameters of a fit beside points and sources.
struct FitOptions {
  double t;  ///< support radius
  LaneDetail detail = LaneDetail::kInvariant;
  int projection_steps = 0;
  const LaneKernels* kernels = &lane_kernels();
};

/// The buffers of fitting.
struct FitBuffers {
  CandidateList near;
  GatedList gated;
  std::vector<std::uint32_t> voxels;
  BlockFrame own;  ///< for a group whose points left the range that its block gathered
};

/// The margin, in t, beyond the support within which sources must be gathered for points that
/// project() moves.
inline constexpr float kMargin = 0.25f;

/// The cosine between normals from which all of these gates are fully open; 0 for no gate.
float open_from(std::span<const Gate> gates);

/// At most kLanes points where they are, and their boxes.
Group place(VoxelSpan points, const BlockFrame& frame, const SourceBox& box,
            const NormalBox& normals);

/// Fits every lane with every gate, one or two: fits[i] with gates[i].
void fit(const Group& group, const Sources& sources, std::span<const Gate> gates,
         const FitOptions& options, FitBuffers& buffers, std::span<GroupFit> fits);

/// Moves the evaluation points, at which `fit` was made, onto the surface until they hardly move,
/// as ExactScaleSpace does. `sources` must be gathered with kMargin.
void project(Group group, const Sources& sources, const Gate& gate, const FitOptions& options,
             FitBuffers& buffers, GroupFit& fit);

}  // namespace pcednet::gls
