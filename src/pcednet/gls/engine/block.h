#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "pcednet/gls/engine/block_frame.h"
#include "pcednet/gls/engine/lane_kernels.h"

namespace pcednet::gls {

/// How sources are chosen: for the points where they are, or in advance for points that will move.
struct Reach {
  float margin = 0.0f;  ///< t: gathered beyond the support
  /// The cosine between normals from which all gates are fully open, 0 without a gate; see
  /// open_from().
  float open_from = 0.0f;
};

/// Whether some normal can reach the cosine `open_from` with every normal of the box.
bool may_be_open(const NormalBox& normals, float open_from);

/// The sources that gates may admit, divided.
struct GatedList {
  Scratch<std::uint32_t> open, rest;
};

/// A part of a block: the sources near it, except those inside the support of all its points, which
/// are summed once.
struct Part {
  CandidateList near, inside;
  GatedList gated;
  InsideSums sums;
};

/// A range of points at one scale: all sources that may affect them, and the part being visited at
/// each depth of the division. Its buffers are reused.
struct Block {
  static constexpr std::size_t kDepth = 4;  ///< of the division, the last one into groups

  std::size_t begin = 0, end = 0;  ///< the points
  BlockFrame frame;
  std::array<Part, kDepth - 1> parts;
};

/// All sources that may affect some points at one scale.
struct Sources {
  const BlockFrame* frame;
  Candidates near;               ///< to be summed point by point
  std::span<const Part> summed;  ///< parts whose inner sources are added
  SourceBox box;                 ///< where the points may be; see is_within()
};

/// The bounding boxes of the positions and of the normals of groups of points.
class GroupBoxes {
 public:
  /// Computes the boxes for the points [begin, end) unless they are known; `begin` starts a group.
  void cover(VoxelSpan points, std::size_t begin, std::size_t end);

  /// The box of the points [begin, end), which must be covered.
  TargetBox box_of(std::size_t begin, std::size_t end) const;

  /// The box of the normals of the groups that contain these points.
  NormalBox normals_of(std::size_t begin, std::size_t end) const;

 private:
  struct Normals {
    std::array<float, 3> min, max;

    void grow(const Normals& other);
  };

  VoxelSpan points_;
  std::size_t begin_ = 0, end_ = 0;
  std::vector<TargetBox> boxes_;
  std::vector<Normals> normals_;
};

/// The box of all lanes of `targets`, in the frame.
SourceBox box_of(const LaneTargets& targets);

/// `box` in the frame.
SourceBox local_box(const BlockFrame& frame, const TargetBox& box);

/// True if the support of every point of `box` is within `margin` of that of a point of `gathered`.
bool is_within(const SourceBox& box, const SourceBox& gathered, float margin);

/// Gathers the entries of `level` within the support at scale t of the points [begin, end), whose
/// box is given. A level that has served a larger scale of the same block is not searched again.
/// False, with nothing gathered, if there are more than `most`.
bool gather(Block& block, std::size_t begin, std::size_t end, const TargetBox& box,
            const VoxelLevel& level, double t, float margin, std::size_t most);

/// The sources of `all` that may affect points in `box` with normals in `normals`, as the block's
/// part of this depth.
Sources choose_part(Block& block, std::size_t depth, const Sources& all, const SourceBox& box,
                    const NormalBox& normals, const Reach& reach, const LaneKernels& kernels);

}  // namespace pcednet::gls
