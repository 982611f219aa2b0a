#include "pcednet/gls/moments.h"

#include "pcednet/gls/kernel.h"

namespace pcednet::gls {
namespace {

// One row per kind of weight; a row is W, P, N, PN, PP and one unused number that makes it even, so
// that the compiler can add two numbers at a time.
constexpr int kWeights = 5;
constexpr int kRow = 10;

Moments from_row(const double* row) {
  return {row[0], {row[1], row[2], row[3]}, {row[4], row[5], row[6]}, row[7], row[8]};
}

}  // namespace

MomentSet sum_moments(std::span<const LocalNeighbour> neighbours, double t) {
  const Kernel kernel(t);
  double sums[kWeights][kRow] = {};
  for (const LocalNeighbour& neighbour : neighbours) {
    const Vec3 &y = neighbour.y, &n = neighbour.n;
    const KernelWeight w = kernel(neighbour.sq_distance);
    const double dx = neighbour.gate * w.dx;
    const double weights[kWeights] = {neighbour.gate * w.value, neighbour.gate * w.dt, dx * y.x(),
                                      dx * y.y(), dx * y.z()};
    const double terms[kRow] = {
        1.0, y.x(), y.y(), y.z(), n.x(), n.y(), n.z(), y.dot(n), neighbour.sq_distance, 0.0};
    for (int k = 0; k < kWeights; ++k) {
      for (int i = 0; i < kRow; ++i) sums[k][i] += weights[k] * terms[i];
    }
  }
  MomentSet set;
  set.count = static_cast<std::uint32_t>(neighbours.size());
  set.value = from_row(sums[0]);
  set.dt = from_row(sums[1]);
  for (std::size_t k = 0; k < 3; ++k) set.dx[k] = from_row(sums[2 + k]);
  return set;
}

}  // namespace pcednet::gls
