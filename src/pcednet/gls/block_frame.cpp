#include "pcednet/gls/block_frame.h"

#include <algorithm>

namespace pcednet::gls {

void CandidateList::reserve(std::size_t count) {
  if (x_.size() < count + kLanes) {
    const std::size_t room = count + count / 2 + kLanes;
    x_.resize(room), y_.resize(room), z_.resize(room), index_.resize(room);
  }
  view = {x_.data(), y_.data(), z_.data(), index_.data(), 0};
}

void BlockFrame::gather(const VoxelLevel& level, const TargetBox& box, const Vec3& origin, double t,
                        float reach) {
  level_ = &level;
  origin_ = origin;
  inverse_t_ = 1.0 / t;
  runs_.clear();
  level.boxes.runs_near(box.min, box.max, reach * t, runs_);
  const std::size_t most = runs_.size() * spatial::BoxTree::kLeaf;
  candidates_.reserve(most);
  if (sources_.size() < most) sources_.resize(most), voxels_.resize(most);

  std::size_t count = 0;
  const auto inverse_t = static_cast<float>(inverse_t_);
  for (const std::uint32_t run : runs_) {
    const std::size_t begin = run * spatial::BoxTree::kLeaf;
    const std::size_t end = std::min(begin + spatial::BoxTree::kLeaf, level.voxels.size());
    for (std::size_t i = begin; i < end; ++i, ++count) {
      const Voxel& v = level.voxels[i];
      const Vec3 p = local(v.position);
      Source& s = sources_[count];
      s = {static_cast<float>(p.x()),
           static_cast<float>(p.y()),
           static_cast<float>(p.z()),
           v.normal[0],
           v.normal[1],
           v.normal[2],
           v.count,
           v.qq * inverse_t * inverse_t,
           v.qn * inverse_t};
      voxels_[count] = static_cast<std::uint32_t>(i);
      candidates_.set(count, s);
    }
  }
  candidates_.view.count = count;
}

}  // namespace pcednet::gls
