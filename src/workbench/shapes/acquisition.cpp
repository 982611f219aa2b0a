#include "workbench/shapes/acquisition.h"

#include <Eigen/Eigenvalues>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/prepare.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {
namespace {

Vec3 plane_normal(std::span<const Vec3> positions, std::span<const spatial::Neighbour> near) {
  Vec3 mean = Vec3::Zero();
  for (const spatial::Neighbour& neighbour : near) mean += positions[neighbour.index];
  mean /= static_cast<double>(near.size());
  Mat3 covariance = Mat3::Zero();
  for (const spatial::Neighbour& neighbour : near) {
    const Vec3 offset = positions[neighbour.index] - mean;
    covariance += offset * offset.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors().col(0);
}

}  // namespace

void add_noise(std::span<Vec3> positions, double sigma, Random& random) {
  for (Vec3& position : positions) {
    for (int axis = 0; axis < 3; ++axis) position[axis] += sigma * random.normal();
  }
}

std::vector<std::size_t> displace_every_tenth(std::span<Vec3> positions, double reach,
                                              Random& random) {
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < positions.size(); i += 10) {
    positions[i] += Vec3::Constant(random.uniform(0.0, reach));
    moved.push_back(i);
  }
  return moved;
}

std::vector<Vec3> plane_normals(std::span<const Vec3> positions, std::size_t neighbours) {
  const spatial::KdTree tree(positions);
  std::vector<Vec3> normals(positions.size());
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(positions[i], neighbours, near);
      normals[i] = plane_normal(positions, near);
    }
  });
  return normals;
}

std::vector<Vec3> oriented_normals(std::span<const Vec3> positions) {
  return normals::estimate_oriented_normals(positions,
                                            {.choice = normals::choose_one_count(positions)})
      .normals;
}

}  // namespace pcednet::shapes
