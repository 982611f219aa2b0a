#include "workbench/shapes/wear.h"

#include <array>
#include <cmath>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/surfaces/sampling.h"

namespace pcednet::shapes {
namespace {

/// Moves a vertex to the mean of the surface around it, of what faces the same way.
void round_off(Vec3& position, Vec3& normal, const SurfaceSamples& surface,
               std::span<const spatial::Neighbour> near, double sigma) {
  double weights = 1e-6;
  Vec3 mean = 1e-6 * position, mean_normal = 1e-6 * normal;
  for (const spatial::Neighbour& neighbour : near) {
    const Vec3& other = surface.normals[neighbour.index];
    if (other.dot(normal) < -0.3) continue;
    const double weight = std::exp(-0.5 * neighbour.sq_distance / (sigma * sigma));
    weights += weight;
    mean += weight * surface.positions[neighbour.index];
    mean_normal += weight * other;
  }
  position = mean / weights;
  normal = mean_normal.normalized();
}

}  // namespace

void wear_off(MeshVertices& vertices, const SurfaceSamples& surface, std::span<const Vec3> edges,
              const Wear& wear, Random& random) {
  const spatial::KdTree edge_tree(edges), tree(surface.positions);
  std::array<Vec3, 3> waves;
  for (Vec3& wave : waves) {
    const Vec3 direction = normal_vector(random);
    wave = random.uniform(5.0, 25.0) * direction;
  }
  parallel_blocks(vertices.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      Vec3& position = vertices.positions[i];
      Vec3& normal = vertices.normals[i];
      edge_tree.nearest(position, 1, near);
      vertices.labels[i] =
          near.empty() ? kNonEdge : class_at(std::sqrt(near.front().sq_distance), wear.bands);
      tree.within(position, 2.5 * wear.rounding, near);
      round_off(position, normal, surface, near, wear.rounding);
      double wave = 0.0;
      for (const Vec3& k : waves) wave += std::sin(k.dot(position)) / 3.0;
      position += wear.waves * wave * normal;
    }
  });
  for (Vec3& position : vertices.positions) {
    for (int a = 0; a < 3; ++a) position[a] += wear.scatter * random.normal();
  }
}

Mat3 gaussian_rotation(Random& random) {
  const Vec3 x = any_direction(random);
  const Vec3 y = x.cross(normal_vector(random)).normalized();
  Mat3 rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

PointCloud finish(MeshVertices vertices, const Finish& finish, const Mat3& rotation) {
  PointCloud cloud;
  for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
    cloud.positions.push_back((rotation * vertices.positions[i]).cast<float>().cast<double>());
    cloud.normals.push_back(rotation * vertices.normals[i]);
  }
  if (finish.estimated) {
    cloud.normals = oriented_normals(cloud.positions);
  }
  if (finish.inward) {
    for (Vec3& normal : cloud.normals) normal = -normal;
  }
  cloud.labels = std::move(vertices.labels);
  cloud.position_type = ScalarType::kFloat32;
  return cloud;
}

}  // namespace pcednet::shapes
