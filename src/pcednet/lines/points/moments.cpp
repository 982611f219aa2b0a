#include "pcednet/lines/points/moments.h"

#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/points/lanes.h"

namespace pcednet::lines {
PCEDNET_VECTOR_CLONES
PointMoments moments_of(const double* x, const double* y, const double* z, const double* weight,
                        std::size_t count) {
  constexpr int kSums = 10;
  Lanes sums[kSums] = {};
  for (std::size_t i = 0; i < count; i += kLanes) {
    Lanes w, px, py, pz;
    load(weight + i, w);
    load(x + i, px);
    load(y + i, py);
    load(z + i, pz);
    const Lanes wx = w * px, wy = w * py, wz = w * pz;
    const Lanes terms[kSums] = {w,       wx,      wy,      wz,      wx * px,
                                wx * py, wy * py, wx * pz, wy * pz, wz * pz};
    for (int k = 0; k < kSums; ++k) sums[k] += terms[k];
  }
  double s[kSums];
  for (int k = 0; k < kSums; ++k) s[k] = sum_of(sums[k]);
  return {.weight = s[0],
          .x = s[1],
          .y = s[2],
          .z = s[3],
          .xx = s[4],
          .xy = s[5],
          .yy = s[6],
          .xz = s[7],
          .yz = s[8],
          .zz = s[9]};
}

}  // namespace pcednet::lines
