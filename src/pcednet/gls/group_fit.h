#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/gls/block.h"
#include "pcednet/gls/fit_status.h"
#include "pcednet/gls/lane_kernels.h"

namespace pcednet::gls {

/// The points [begin, begin + count) of the pyramid's first level, at most kLanes of them.
struct LaneGroup {
  std::size_t begin, count;
};

/// The evaluation points of a group: its points, and where in a frame they have moved to.
struct Group {
  std::span<const Voxel> points;
  LaneTargets targets;
  SourceBox box;                                          ///< of the targets
  NormalBox normals;                                      ///< theirs
  std::array<std::array<float, 3>, kLanes> offsets = {};  ///< from the points, in t
};

/// What is known of a group of points at one scale.
struct GroupFit {
  std::array<FitStatus, kLanes> status;
  LaneFits fits = {};  ///< features are finite, and 0 where undefined
};

/// The threshold of side_gate(), or none.
using Gate = std::optional<double>;

/// What decides a fit beside points and sources.
struct FitOptions {
  double t;  ///< support radius
  LaneDetail detail = LaneDetail::kInvariant;
  int projection_steps = 0;
  const LaneKernels* kernels = &lane_kernels();
};

/// What fitting needs room for.
struct FitBuffers {
  CandidateList near;
  GatedList gated;
  std::vector<std::uint32_t> voxels;
  BlockFrame own;  ///< of a group whose points left what its block gathered
};

/// t: what must be gathered beyond the support for points that project() moves.
inline constexpr float kMargin = 0.25f;

/// The cosine of normals from which all of these gates are wide open; 0 for no gate.
float open_from(std::span<const Gate> gates);

/// `points` where they are, at most kLanes of them, and their boxes.
Group place(std::span<const Voxel> points, const BlockFrame& frame, const SourceBox& box,
            const NormalBox& normals);

/// Fits every lane with every gate, one or two: fits[i] with gates[i].
void fit(const Group& group, const Sources& sources, std::span<const Gate> gates,
         const FitOptions& options, FitBuffers& buffers, std::span<GroupFit> fits);

/// As ExactScaleSpace does it: moves the evaluation points, which are where `fit` was made, onto
/// the surface until they hardly move. `sources` must be gathered with kMargin.
void project(Group group, const Sources& sources, const Gate& gate, const FitOptions& options,
             FitBuffers& buffers, GroupFit& fit);

}  // namespace pcednet::gls
