#include "pcednet/gls/moments.h"

#include "pcednet/gls/kernel.h"

namespace pcednet::gls {
namespace {

constexpr int kWeights = 5;
using Sums = Eigen::Matrix<double, LocalNeighbour::Row::RowsAtCompileTime, kWeights>;

Moments from_column(const Sums& sums, int k) {
  const LocalNeighbour::Row s = sums.col(k);
  return {s[0], s.segment<3>(1), s.segment<3>(4), s[7], s[8]};
}

}  // namespace

MomentSet sum_moments(std::span<const LocalNeighbour> neighbours, double t) {
  const Kernel kernel(t);
  Sums sums = Sums::Zero();
  for (const LocalNeighbour& neighbour : neighbours) {
    const LocalNeighbour::Row& row = neighbour.row();
    const KernelWeight w = kernel(neighbour.sq_distance());
    const double dx = neighbour.gate() * w.dx;
    const double weights[kWeights] = {neighbour.gate() * w.value, neighbour.gate() * w.dt,
                                      dx * row[1], dx * row[2], dx * row[3]};
    for (int k = 0; k < kWeights; ++k) sums.col(k) += weights[k] * row;
  }
  MomentSet set;
  set.count = static_cast<std::uint32_t>(neighbours.size());
  set.value = from_column(sums, 0);
  set.dt = from_column(sums, 1);
  for (int k = 0; k < 3; ++k) set.dx[static_cast<std::size_t>(k)] = from_column(sums, 2 + k);
  return set;
}

}  // namespace pcednet::gls
