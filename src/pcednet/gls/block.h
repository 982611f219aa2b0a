#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "pcednet/gls/block_frame.h"
#include "pcednet/gls/lane_kernels.h"

namespace pcednet::gls {

/// How sources are chosen: for the points as they are, or in advance for points that will move.
struct Reach {
  float margin = 0.0f;  ///< t: gathered beyond the support
  /// The cosine of normals from which all gates are wide open, 0 without a gate; see open_from().
  float open_from = 0.0f;
};

/// Whether some normal can have the cosine to every normal of the box from which gates are open.
bool may_be_open(const NormalBox& normals, float open_from);

/// The sources that gates may let in, divided.
struct GatedList {
  Room<std::uint32_t> open, rest;
};

/// A part of a block: the sources near it, less those inside the support of its every point, which
/// are summed up once.
struct Part {
  CandidateList near, inside;
  GatedList gated;
  InsideSums sums;
};

/// A stretch of points at one scale: all sources that they may meet, and for each depth of its
/// division the part that is being visited. Its buffers last from one use to the next.
struct Block {
  static constexpr std::size_t kDepth = 4;  ///< of the division, the last one into groups

  std::size_t begin = 0, end = 0;  ///< the points
  BlockFrame frame;
  std::array<Part, kDepth - 1> parts;
};

/// All sources that some points at one scale may meet.
struct Sources {
  const BlockFrame* frame;
  Candidates near;               ///< to be summed point by point
  std::span<const Part> summed;  ///< parts whose sources inside come in addition
  SourceBox box;                 ///< where the points may be; beyond, see is_within()
};

/// The boxes of the groups of some points, and of their normals.
class GroupBoxes {
 public:
  /// Finds those of the points [begin, end) unless they are known; `begin` is that of a group.
  void cover(std::span<const Voxel> points, std::size_t begin, std::size_t end);

  /// Of the points [begin, end), which are covered.
  TargetBox box_of(std::size_t begin, std::size_t end) const;

  /// Of the normals of the groups that these points belong to.
  NormalBox normals_of(std::size_t begin, std::size_t end) const;

 private:
  struct Normals {
    std::array<float, 3> min, max;

    void grow(const Normals& other);
  };

  std::span<const Voxel> points_;
  std::size_t begin_ = 0, end_ = 0;
  std::vector<TargetBox> boxes_;
  std::vector<Normals> normals_;
};

/// The box of all lanes in `targets`, in the frame.
SourceBox box_of(const LaneTargets& targets);

/// `box` in the frame.
SourceBox local_box(const BlockFrame& frame, const TargetBox& box);

/// True if the support of every point of `box` is within `margin` of that of a point of `gathered`.
bool is_within(const SourceBox& box, const SourceBox& gathered, float margin);

/// Gathers for the points [begin, end), whose box is given, what `level` holds within the support
/// of scale t. A level that served a larger scale of the same block before is not searched again.
/// False, and nothing is gathered, if that is more than `most`.
bool gather(Block& block, std::size_t begin, std::size_t end, const TargetBox& box,
            const VoxelLevel& level, double t, float margin, std::size_t most);

/// The sources of `all` that points in `box` with normals in `normals` may meet, as the block's
/// part of this depth.
Sources choose_part(Block& block, std::size_t depth, const Sources& all, const SourceBox& box,
                    const NormalBox& normals, const Reach& reach, const LaneKernels& kernels);

}  // namespace pcednet::gls
