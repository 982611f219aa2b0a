#include "pcednet/spatial/search_kernels.h"

#include <cmath>
#include <limits>

#include "pcednet/core/vector_clones.h"

namespace pcednet::spatial {
namespace {

constexpr std::size_t kStep = Candidates::kStep;

}  // namespace

PCEDNET_VECTOR_CLONES
void sq_gaps(const EightBoxes& boxes, const double min[3], const double max[3],
             double* __restrict out) {
  const double min_x = min[0], min_y = min[1], min_z = min[2];
  const double max_x = max[0], max_y = max[1], max_z = max[2];
  for (std::size_t b = 0; b < 8; ++b) {
    const double below_x = boxes.min[0][b] - max_x, above_x = min_x - boxes.max[0][b];
    const double below_y = boxes.min[1][b] - max_y, above_y = min_y - boxes.max[1][b];
    const double below_z = boxes.min[2][b] - max_z, above_z = min_z - boxes.max[2][b];
    double x = below_x > above_x ? below_x : above_x;
    double y = below_y > above_y ? below_y : above_y;
    double z = below_z > above_z ? below_z : above_z;
    x = x > 0.0 ? x : 0.0;
    y = y > 0.0 ? y : 0.0;
    z = z > 0.0 ? z : 0.0;
    out[b] = x * x + y * y + z * z;
  }
}

PCEDNET_VECTOR_CLONES
void add_near(const double* const positions[3], std::size_t begin, std::size_t count,
              Candidates& candidates) {
  const std::size_t first = candidates.count;
  float *const x = candidates.x + first, *const y = candidates.y + first,
               *const z = candidates.z + first, *const sq = candidates.sq + first;
  const double *const from_x = positions[0] + begin, *const from_y = positions[1] + begin,
                      *const from_z = positions[2] + begin;
  const double cx = candidates.centre[0], cy = candidates.centre[1], cz = candidates.centre[2];
  const double scale = candidates.scale;
  const float hx = candidates.half[0], hy = candidates.half[1], hz = candidates.half[2];
  for (std::size_t i = 0; i < kStep; ++i) {
    const float lx = static_cast<float>((from_x[i] - cx) * scale);
    const float ly = static_cast<float>((from_y[i] - cy) * scale);
    const float lz = static_cast<float>((from_z[i] - cz) * scale);
    x[i] = lx, y[i] = ly, z[i] = lz;
    const float gx = std::fabs(lx) - hx, gy = std::fabs(ly) - hy, gz = std::fabs(lz) - hz;
    const float ax = gx > 0.0f ? gx : 0.0f, ay = gy > 0.0f ? gy : 0.0f, az = gz > 0.0f ? gz : 0.0f;
    sq[i] = ax * ax + ay * ay + az * az;
  }
  std::uint32_t* const index = candidates.index + first;
  const float most = candidates.sq_radius;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    x[kept] = x[i], y[kept] = y[i], z[kept] = z[i];
    index[kept] = static_cast<std::uint32_t>(begin + i);
    kept += sq[i] <= most;
  }
  candidates.count = first + kept;
}

PCEDNET_VECTOR_CLONES
std::size_t pick_nearest(Candidates& candidates, const float q[3], std::size_t wanted,
                         float sq_guess, std::uint32_t* picked) {
  const std::size_t steps = (candidates.count + kStep - 1) / kStep;
  const float qx = q[0], qy = q[1], qz = q[2], most = candidates.sq_radius;
  for (std::size_t i = candidates.count; i < steps * kStep; ++i) {
    candidates.x[i] = std::numeric_limits<float>::infinity();
  }
  float bound = sq_guess > 0.0f && sq_guess < most ? sq_guess : most;
  std::uint32_t within = 0;
  for (std::size_t i = 0; i < steps * kStep; ++i) {
    const float dx = candidates.x[i] - qx, dy = candidates.y[i] - qy, dz = candidates.z[i] - qz;
    const float sq = dx * dx + dy * dy + dz * dz;
    candidates.sq[i] = sq;
    within += sq <= bound ? 1u : 0u;
  }
  for (float growth = 1.5f; within < wanted; growth *= growth) {
    if (!(bound < most)) return 0;
    bound = growth * bound < most ? growth * bound : most;
    within = 0;
    for (std::size_t i = 0; i < steps * kStep; ++i) within += candidates.sq[i] <= bound ? 1u : 0u;
  }
  // Includes points that rounding may have moved outwards.
  const float reach = std::sqrt(bound) + Candidates::kError;
  bound = reach * reach * 1.00001f;
  std::size_t count = 0;
  for (std::size_t i = 0; i < candidates.count; ++i) {
    picked[count] = candidates.index[i];
    count += candidates.sq[i] <= bound;
  }
  return count;
}

PCEDNET_VECTOR_CLONES
void sq_distances(const double* const positions[3], std::uint32_t query, const std::uint32_t* index,
                  std::size_t count, double* out) {
  const double *x = positions[0], *y = positions[1], *z = positions[2];
  const double qx = x[query], qy = y[query], qz = z[query];
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t j = index[i];
    const double dx = x[j] - qx, dy = y[j] - qy, dz = z[j] - qz;
    out[i] = dx * dx + dy * dy + dz * dz;
  }
  for (std::size_t i = 0; i < kStep; ++i) out[count + i] = std::numeric_limits<double>::infinity();
}

}  // namespace pcednet::spatial
