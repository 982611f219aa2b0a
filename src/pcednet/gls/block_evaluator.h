#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/gls/block_frame.h"
#include "pcednet/gls/fit_status.h"
#include "pcednet/gls/lane_kernels.h"
#include "pcednet/gls/lane_recheck.h"

namespace pcednet::gls {

struct BlockOptions {
  LaneDetail detail = LaneDetail::kInvariant;
  int projection_steps = 0;
  std::optional<double> side_gate;
};

/// The points [begin, begin + count) of the pyramid's first level, at most kLanes of them.
struct LaneGroup {
  std::size_t begin, count;
};

/// What is known of a group of points at one scale.
struct GroupFit {
  std::array<FitStatus, kLanes> status;
  LaneFits fits = {};  ///< features are finite, and 0 where undefined
};

/// Describes the points of a pyramid's first level from the level that serves each scale, a block
/// at a time. Holds the buffers for that, so that none is allocated per point: one per thread.
class BlockEvaluator {
 public:
  static constexpr std::size_t kDepth = 4;  ///< of the division of a block

  using Wanted = std::function<bool(const LaneGroup&)>;
  using Emit = std::function<void(const LaneGroup&, const GroupFit&)>;

  BlockEvaluator(const VoxelPyramid& pyramid, const BlockOptions& options,
                 const LaneKernels& kernels = lane_kernels());

  /// Calls `emit` for the groups of the points [begin, end) that are `wanted`, at the scale with
  /// this index and support radius. `begin` must be a multiple of kLanes. What a group gets depends
  /// on begin and end, not on which other groups are wanted.
  void evaluate(std::size_t begin, std::size_t end, std::size_t scale, double t,
                const Wanted& wanted, const Emit& emit);

  /// Sources times targets summed so far.
  std::uint64_t interactions() const { return interactions_; }

 private:
  /// A part of the block: the sources near it, less those inside the support of its every point,
  /// which are summed up once.
  struct Part {
    CandidateList near = {}, inside = {};
    InsideSums sums = {};
  };
  struct Visit {
    double t;
    const Wanted& wanted;
    const Emit& emit;
  };

  void find_boxes(std::size_t begin, std::size_t end);
  TargetBox box_of(std::size_t begin, std::size_t end) const;
  void evaluate_group(const LaneGroup& group, const BlockFrame& frame, const Candidates& near,
                      const SourceBox& gathered, double t, GroupFit& result);
  void gather_block(std::size_t begin, std::size_t end, const VoxelLevel& level,
                    const TargetBox& box, double t, float reach);
  static bool any_wanted(std::size_t begin, std::size_t end, const Wanted& wanted);
  void visit_parts(std::size_t depth, std::size_t begin, std::size_t end, const Candidates& near,
                   const SourceBox& box, const Visit& visit);
  void choose_sources(const Candidates& all, const SourceBox& box, Part& part);
  /// What comes in addition to what is gathered in `frame`.
  std::span<const Part> shared(const BlockFrame& frame) const {
    return std::span(parts_).first(&frame == &block_ ? parts_.size() : 0);
  }
  void load_targets(const LaneGroup& group, const BlockFrame& frame);
  void fit_lanes(const LaneGroup& group, const BlockFrame& frame, const Candidates& near, double t,
                 GroupFit& result);
  void find_status(const LaneGroup& group, const BlockFrame& frame, double t, GroupFit& result);
  void settle(const LaneGroup& group, const BlockFrame& frame, double t, GroupFit& result);
  void project(const LaneGroup& group, const BlockFrame& frame, const Candidates& near,
               const SourceBox& gathered, double t, GroupFit& result);
  bool step(const LaneGroup& group, GroupFit& result);
  DoubtfulTarget doubtful(const LaneGroup& group, std::size_t lane, double t) const;
  std::span<const std::uint32_t> candidate_voxels(const BlockFrame& frame);

  const VoxelPyramid* pyramid_;
  BlockOptions options_;
  LaneGate gate_;
  const LaneKernels* kernels_;
  std::size_t boxes_begin_ = 0, boxes_end_ = 0;
  std::vector<TargetBox> boxes_;  ///< of the groups of these points, kept from scale to scale
  std::size_t gathered_begin_ = 0, gathered_end_ = 0;
  const VoxelLevel* gathered_level_ = nullptr;
  BlockFrame block_, own_;  ///< of a block; of a group whose points left what that gathered
  std::array<Part, kDepth - 1> parts_;
  CandidateList group_;  ///< near a group
  std::vector<std::uint32_t> voxels_;
  LaneTargets targets_;
  std::array<std::array<float, 3>, kLanes> offset_, move_;  ///< from the point to where it is, in t
  std::array<bool, kLanes> moving_;
  LaneSums sums_;
  LaneCounts counts_;
  GroupFit result_, next_;
  float margin_ = 0.0f;  ///< t: gathered beyond the support for points that will move
  std::uint64_t interactions_ = 0;
};

}  // namespace pcednet::gls
