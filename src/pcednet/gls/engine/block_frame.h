#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/core/unset_array.h"
#include "pcednet/core/vec3.h"
#include "pcednet/gls/engine/lane_types.h"
#include "pcednet/gls/engine/voxel_pyramid.h"

namespace pcednet::gls {

/// The support in units of t, with an allowance for rounding.
inline constexpr float kReach = 1.00001f;

/// A buffer for values that are written before they are read: it grows without keeping or clearing
/// them.
template <typename Value>
class Scratch {
 public:
  /// At least `count` values.
  Value* make(std::size_t count) {
    if (values_.size() < count) values_ = UnsetArray<Value>(count + count / 2);
    return values_.data();
  }
  Value* data() { return values_.data(); }
  const Value* data() const { return values_.data(); }

 private:
  UnsetArray<Value> values_;
};

/// Owns the arrays of Candidates, which the kernels fill.
class CandidateList {
 public:
  void reserve(std::size_t count);
  void set(std::size_t i, const Source& source) {
    view.x[i] = source.x, view.y[i] = source.y, view.z[i] = source.z;
    view.index[i] = static_cast<std::uint32_t>(i);
  }
  /// There must be room.
  void add(std::uint32_t index, const Source& source) {
    const std::size_t i = view.count++;
    set(i, source);
    view.index[i] = index;
  }

  Candidates view = {};

 private:
  Scratch<float> x_, y_, z_;
  Scratch<std::uint32_t> index_;
};

/// An axis-aligned box of evaluation points.
struct TargetBox {
  Vec3 min, max;

  void grow(const Vec3& position) {
    min = min.cwiseMin(position);
    max = max.cwiseMax(position);
  }
  Vec3 centre() const { return 0.5 * (min + max); }
  double longest_side() const { return (max - min).maxCoeff(); }
};

/// The sources for evaluation points at scale t: the entries of a level near a box, in single
/// precision, about an origin in the box and in units of t. Its buffers are reused.
class BlockFrame {
 public:
  /// Gathers every voxel of `level` closer than `reach` t to `box`, and some more. `box` must be
  /// within 32 t of `origin` for coordinates accurate to 2e-6. False, with nothing gathered, if
  /// there are more than `most`.
  bool gather(const VoxelLevel& level, const TargetBox& box, const Vec3& origin, double t,
              float reach, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// Changes the scale of the gathered entries; `reach` t must not grow.
  void rescale(double t);

  /// True if the frame holds all entries of `level` closer to the box than `reach`, in the cloud's
  /// units.
  bool holds(const VoxelLevel& level, double reach) const {
    return &level == level_ && reach <= reach_;
  }
  const Vec3& origin() const { return origin_; }
  const VoxelLevel& level() const { return *level_; }
  double inverse_t() const { return inverse_t_; }
  const Candidates& candidates() const { return candidates_.view; }
  const Source* sources() const { return sources_.data(); }

  /// The voxel of the level that is source `i`.
  std::uint32_t voxel(std::uint32_t i) const { return entries_.data()[i].voxel; }

  /// A position in the frame.
  Vec3 local(const Vec3& position) const { return (position - origin_) * inverse_t_; }

 private:
  struct Entry {
    double position[3];  ///< from the origin
    float qq, qn;
    std::uint32_t voxel;
  };

  const VoxelLevel* level_ = nullptr;
  Vec3 origin_ = Vec3::Zero();
  double inverse_t_ = 1.0, reach_ = 0.0;
  std::vector<std::uint32_t> runs_;
  Scratch<Source> sources_;
  Scratch<Entry> entries_;
  CandidateList candidates_;
};

}  // namespace pcednet::gls
