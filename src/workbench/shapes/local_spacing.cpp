#include "workbench/shapes/local_spacing.h"

#include <cmath>

#include "pcednet/core/parallel.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {

std::vector<double> local_spacings(std::span<const Vec3> positions) {
  constexpr std::size_t kNeighbours = 11;      // the point itself among them
  constexpr double kSpacingsOfTheMean = 1.25;  // on a grid, to the ten nearest
  const spatial::KdTree tree(positions);
  std::vector<double> spacings(positions.size());
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(positions[i], kNeighbours, near);
      double sum = 0.0;
      for (const auto& neighbour : near) sum += std::sqrt(neighbour.sq_distance);
      spacings[i] = sum / (kSpacingsOfTheMean * static_cast<double>(kNeighbours - 1));
    }
  });
  return spacings;
}

}  // namespace pcednet::shapes
