#include "pcednet/gls/engine/block_frame.h"

#include <algorithm>

#include "pcednet/core/prefetch.h"

namespace pcednet::gls {

void CandidateList::reserve(std::size_t count) {
  const std::size_t room = count + kLanes;
  view = {x_.make(room), y_.make(room), z_.make(room), index_.make(room), 0};
}

bool BlockFrame::gather(const VoxelLevel& level, const TargetBox& box, const Vec3& origin, double t,
                        float reach, std::size_t most) {
  level_ = &level;
  origin_ = origin;
  reach_ = reach * t;
  runs_.clear();
  constexpr double kSlack = 1.000005;  // the kernels measure in float
  level.boxes.runs_near(box.min, box.max, kSlack * reach_, runs_);
  const std::size_t room = runs_.size() * spatial::BoxTree::kLeaf;
  if (room > most) {
    level_ = nullptr;
    return false;
  }
  candidates_.reserve(room);
  Source* const sources = sources_.make(room);
  Entry* const entries = entries_.make(room);

  const VoxelSpan voxels = level.voxels;
  std::size_t count = 0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t begin = runs_[r] * spatial::BoxTree::kLeaf;
    if (r + kAskAhead < runs_.size()) {
      const std::size_t later = runs_[r + kAskAhead] * spatial::BoxTree::kLeaf;
      voxels.subspan(later, spatial::BoxTree::kLeaf).prefetch_all();
    }
    const std::size_t end = std::min(begin + spatial::BoxTree::kLeaf, voxels.size());
    for (std::size_t i = begin; i < end; ++i) {
      const Voxel v = voxels[i];
      if (v.count == 0.0f) continue;  // has no normal
      const Vec3 p = v.position - origin;
      entries[count] = {{p.x(), p.y(), p.z()}, v.qq, v.qn, static_cast<std::uint32_t>(i)};
      Source& s = sources[count];
      s.nx = v.normal[0], s.ny = v.normal[1], s.nz = v.normal[2];
      s.count = v.count;
      ++count;
    }
  }
  candidates_.view.count = count;
  rescale(t);
  return true;
}

void BlockFrame::rescale(double t) {
  inverse_t_ = 1.0 / t;
  const auto inverse_t = static_cast<float>(inverse_t_);
  const Entry* const entries = entries_.data();
  Source* const sources = sources_.data();
  for (std::size_t i = 0; i < candidates_.view.count; ++i) {
    const Entry& e = entries[i];
    Source& s = sources[i];
    s.x = static_cast<float>(e.position[0] * inverse_t_);
    s.y = static_cast<float>(e.position[1] * inverse_t_);
    s.z = static_cast<float>(e.position[2] * inverse_t_);
    s.qq = e.qq * inverse_t * inverse_t, s.qn = e.qn * inverse_t;
    candidates_.set(i, s);
  }
}

}  // namespace pcednet::gls
