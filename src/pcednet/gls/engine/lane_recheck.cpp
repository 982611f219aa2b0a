#include "pcednet/gls/engine/lane_recheck.h"

#include <algorithm>

#include "pcednet/gls/kernel.h"
#include "pcednet/gls/neighbourhood.h"

namespace pcednet::gls {
namespace {

/// A voxel as a neighbour: its means stand for each of its points.
struct VoxelNeighbour {
  Vec3 y, n;
  double sq_distance, yn, gate, count;
};

/// Calls `use` for every voxel within the support whose gate is not shut.
template <typename Use>
void for_neighbours(const DoubtfulTarget& target, const VoxelLevel& level,
                    std::span<const std::uint32_t> candidates, Use&& use) {
  const bool gated = target.gate && !target.normal.isZero(0.0);
  for (const std::uint32_t i : candidates) {
    const Voxel v = level.voxels[i];
    VoxelNeighbour j;
    j.y = (v.position - target.position) - target.offset;
    j.sq_distance = j.y.x() * j.y.x() + j.y.y() * j.y.y() + j.y.z() * j.y.z() + v.qq;
    if (!(j.sq_distance < target.t * target.t)) continue;
    j.n = Vec3(v.normal[0], v.normal[1], v.normal[2]);
    j.gate = gated ? side_gate(j.n, target.normal, *target.gate) : 1.0;
    if (j.gate == 0.0) continue;
    j.yn = j.y.dot(j.n) + v.qn;
    j.count = v.count;
    use(j);
  }
}

void add(Moments& m, double weight, const VoxelNeighbour& j) {
  m.w += weight;
  m.p += weight * j.y;
  m.n += weight * j.n;
  m.pn += weight * j.yn;
  m.pp += weight * j.sq_distance;
}

}  // namespace

FitStatus recheck_status(const DoubtfulTarget& target, const VoxelLevel& level,
                         std::span<const std::uint32_t> candidates) {
  double count = 0.0;
  for_neighbours(target, level, candidates, [&](const VoxelNeighbour& j) { count += j.count; });
  return status_of_count(static_cast<std::uint32_t>(std::min(count, 1e9)));
}

RecheckedFit recheck_fit(const DoubtfulTarget& target, const VoxelLevel& level,
                         std::span<const std::uint32_t> candidates) {
  const Kernel kernel(target.t);
  MomentSet moments;
  double count = 0.0;
  for_neighbours(target, level, candidates, [&](const VoxelNeighbour& j) {
    const KernelWeight w = kernel(j.sq_distance);
    const double weight = j.gate * j.count;
    count += j.count;
    add(moments.value, weight * w.value, j);
    add(moments.dt, weight * w.dt, j);
    for (int k = 0; k < 3; ++k) {
      add(moments.dx[static_cast<std::size_t>(k)], weight * w.dx * j.y[k], j);
    }
  });
  moments.count = static_cast<std::uint32_t>(std::min(count, 1e9));
  RecheckedFit result;
  result.fit = fit_sphere(moments.value, moments.count, target.t);
  result.descriptor = describe_sphere(result.fit, moments);
  return result;
}

}  // namespace pcednet::gls
