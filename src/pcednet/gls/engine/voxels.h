#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "pcednet/core/prefetch.h"
#include "pcednet/core/unset_array.h"
#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// A mean normal, not renormalised.
using MeanNormal = std::array<float, 3>;

/// A voxel that represents the points in it, or a single point.
///
/// Moments add, so a sum over a neighbourhood may use a voxel for its points when the voxel is
/// small compared with the support. `qq` and `qn` remove the second-order bias: points on one
/// sphere are still fitted exactly.
struct Voxel {
  Vec3 position;  ///< mean position
  MeanNormal normal;
  float count;  ///< points; 0 for a point whose normal is unusable
  float qq;     ///< mean |q|^2, q the position of its points about `position`
  float qn;     ///< mean q.n likewise
};

/// The part of a voxel that a single point can do without.
struct VoxelMoments {
  float count, qq, qn;
};

/// Some voxels of a level.
class VoxelSpan {
 public:
  VoxelSpan() = default;
  /// `moments` is null for single points.
  VoxelSpan(const Vec3* positions, const MeanNormal* normals, const VoxelMoments* moments,
            std::size_t size)
      : positions_(positions), normals_(normals), moments_(moments), size_(size) {}

  std::size_t size() const { return size_; }
  const Vec3& position(std::size_t i) const { return positions_[i]; }
  const MeanNormal& normal(std::size_t i) const { return normals_[i]; }
  float count(std::size_t i) const { return moments(i).count; }
  Voxel operator[](std::size_t i) const {
    const auto [count, qq, qn] = moments(i);
    return {positions_[i], normals_[i], count, qq, qn};
  }

  VoxelSpan subspan(std::size_t begin, std::size_t count) const {
    return {positions_ + begin, normals_ + begin, moments_ ? moments_ + begin : nullptr, count};
  }

  /// Asks for a voxel that is soon read.
  void prefetch(std::size_t i) const {
    pcednet::prefetch(positions_[i]);
    pcednet::prefetch(normals_[i]);
    if (moments_) pcednet::prefetch(moments_[i]);
  }
  /// The same for all of them.
  void prefetch_all() const {
    pcednet::prefetch_all(std::span(positions_, size_));
    pcednet::prefetch_all(std::span(normals_, size_));
    if (moments_) pcednet::prefetch_all(std::span(moments_, size_));
  }

 private:
  /// Those of a single point follow from its normal, which is 0 if it is unusable.
  VoxelMoments moments(std::size_t i) const {
    if (moments_) return moments_[i];
    return {normals_[i] == MeanNormal{} ? 0.0f : 1.0f, 0.0f, 0.0f};
  }

  const Vec3* positions_ = nullptr;
  const MeanNormal* normals_ = nullptr;
  const VoxelMoments* moments_ = nullptr;
  std::size_t size_ = 0;
};

/// The voxels of a level: 48 bytes each, or 36 for single points.
class VoxelArray {
 public:
  VoxelArray() = default;
  static VoxelArray of_points(std::size_t size) { return VoxelArray(size, 0); }
  static VoxelArray of_voxels(std::size_t size) { return VoxelArray(size, size); }

  std::size_t size() const { return positions_.size(); }
  void set_point(std::size_t i, const Vec3& position, const MeanNormal& normal) {
    positions_[i] = position, normals_[i] = normal;
  }
  void set(std::size_t i, const Voxel& voxel) {
    set_point(i, voxel.position, voxel.normal);
    moments_[i] = {voxel.count, voxel.qq, voxel.qn};
  }
  operator VoxelSpan() const {
    return {positions_.data(), normals_.data(), moments_.size() > 0 ? moments_.data() : nullptr,
            positions_.size()};
  }
  Voxel operator[](std::size_t i) const { return VoxelSpan(*this)[i]; }

 private:
  VoxelArray(std::size_t size, std::size_t with_moments)
      : positions_(size), normals_(size), moments_(with_moments) {}

  UnsetArray<Vec3> positions_;
  UnsetArray<MeanNormal> normals_;
  UnsetArray<VoxelMoments> moments_;
};

}  // namespace pcednet::gls
