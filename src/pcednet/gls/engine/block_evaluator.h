#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "pcednet/gls/engine/block.h"
#include "pcednet/gls/engine/group_fit.h"

namespace pcednet::gls {

struct BlockOptions {
  LaneDetail detail = LaneDetail::kInvariant;
  int projection_steps = 0;
  std::vector<Gate> gates = {{}};  ///< one or two; if two, neither is open
};

/// Describes the points of a pyramid's first level from the level that serves each scale, block by
/// block. Owns the buffers, so that none is allocated per point.
class BlockEvaluator {
 public:
  using Wanted = std::function<bool(const LaneGroup&)>;
  using Emit = std::function<void(const LaneGroup&, std::span<const GroupFit>)>;

  BlockEvaluator(const VoxelPyramid& pyramid, const BlockOptions& options,
                 const LaneKernels& kernels = lane_kernels());

  /// Calls `emit`, with a fit per gate, for the groups of the points [begin, end) that are
  /// `wanted`, at the scale with this index and support radius. `begin` must be a multiple of
  /// kLanes. The result of a group depends on begin and end, not on which other groups are wanted.
  void evaluate(std::size_t begin, std::size_t end, std::size_t scale, double t,
                const Wanted& wanted, const Emit& emit);

 private:
  struct Visit {
    FitOptions fit;
    Reach reach;
    const Wanted& wanted;
    const Emit& emit;
  };

  void evaluate_halves(std::size_t begin, std::size_t end, std::size_t scale, double t,
                       const Wanted& wanted, const Emit& emit);
  void visit_parts(std::size_t depth, std::size_t begin, std::size_t end, const Sources& sources,
                   const Visit& visit);
  NormalBox normals_of(std::size_t begin, std::size_t end, const Visit& visit) const;
  void visit_group(const LaneGroup& group, const Sources& sources, const Visit& visit);

  const VoxelPyramid* pyramid_;
  BlockOptions options_;
  const LaneKernels* kernels_;
  GroupBoxes boxes_;  ///< kept from scale to scale
  Block block_;
  FitBuffers buffers_;
  std::array<GroupFit, 2> fits_;
};

}  // namespace pcednet::gls
