#include "pcednet/gls/block_frame.h"

#include <algorithm>

namespace pcednet::gls {

constexpr std::size_t kAhead = 3;

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
  reach_ = reach * t;
  runs_.clear();
  level.boxes.runs_near(box.min, box.max, reach_, runs_);
  const std::size_t most = runs_.size() * spatial::BoxTree::kLeaf;
  candidates_.reserve(most);
  if (sources_.size() < most) sources_.resize(most), entries_.resize(most);

  std::size_t count = 0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t begin = runs_[r] * spatial::BoxTree::kLeaf;
    if (r + kAhead < runs_.size()) {
      const std::size_t later = runs_[r + kAhead] * spatial::BoxTree::kLeaf;
      for (std::size_t i = 0; i < spatial::BoxTree::kLeaf; ++i) {
        __builtin_prefetch(level.voxels.data() + later + i);
      }
    }
    const std::size_t end = std::min(begin + spatial::BoxTree::kLeaf, level.voxels.size());
    for (std::size_t i = begin; i < end; ++i) {
      const Voxel& v = level.voxels[i];
      if (v.count == 0.0f) continue;  // has no normal
      entries_[count] = {v.position - origin, v.qq, v.qn, static_cast<std::uint32_t>(i)};
      Source& s = sources_[count];
      s.nx = v.normal[0], s.ny = v.normal[1], s.nz = v.normal[2];
      s.count = v.count;
      ++count;
    }
  }
  candidates_.view.count = count;
  rescale(t);
}

void BlockFrame::rescale(double t) {
  inverse_t_ = 1.0 / t;
  const auto inverse_t = static_cast<float>(inverse_t_);
  for (std::size_t i = 0; i < candidates_.view.count; ++i) {
    const Entry& e = entries_[i];
    const Vec3 p = e.position * inverse_t_;
    Source& s = sources_[i];
    s.x = static_cast<float>(p.x()), s.y = static_cast<float>(p.y());
    s.z = static_cast<float>(p.z());
    s.qq = e.qq * inverse_t * inverse_t, s.qn = e.qn * inverse_t;
    candidates_.set(i, s);
  }
}

}  // namespace pcednet::gls
