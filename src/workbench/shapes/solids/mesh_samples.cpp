#include "workbench/shapes/solids/mesh_samples.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pcednet/core/error.h"
#include "pcednet/core/random.h"

namespace pcednet::shapes {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Twice the area, along the normal; zero where a corner is not finite.
Vec3 area_vector(const std::vector<Vec3>& p, const Triangle& t) {
  const Vec3 vector = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
  return vector.allFinite() ? vector : Vec3(Vec3::Zero());
}

std::vector<double> sums_of_areas(const std::vector<Vec3>& positions,
                                  std::span<const Triangle> triangles) {
  std::vector<double> sums;
  double sum = 0.0;
  for (const Triangle& triangle : triangles) {
    sums.push_back(sum += area_vector(positions, triangle).norm());
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    throw Error(ErrorKind::kInsufficient, "there are no faces with an area to sample");
  }
  return sums;
}

Rgb blend(const std::vector<Rgb>& colours, const Triangle& t, const Vec3& weights) {
  Rgb colour = {};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += weights[k] * colours[t[static_cast<std::size_t>(k)]][c];
    colour[c] = static_cast<std::uint8_t>(std::clamp(std::round(sum), 0.0, 255.0));
  }
  return colour;
}

}  // namespace

PointCloud sample_mesh(const PointCloud& vertices, std::span<const Triangle> triangles,
                       const MeshSampleOptions& options, const Progress* progress) {
  if (options.vertex_normals && !vertices.has_normals()) {
    throw Error(ErrorKind::kInsufficient, "the vertices have no normals to interpolate");
  }
  const std::vector<double> sums = sums_of_areas(vertices.positions, triangles);
  Random random(options.seed);
  PointCloud cloud;
  cloud.comments = vertices.comments;
  cloud.comments.push_back(
      fmt::format("sample: {} points on the faces, seed {}", options.points, options.seed));
  cloud.positions.reserve(options.points);
  cloud.normals.reserve(options.points);
  if (!vertices.colours.empty()) cloud.colours.reserve(options.points);
  constexpr std::size_t kAtOnce = 4096;  // between looks at the caller
  Stage stage(progress, "sample", options.points);
  for (std::size_t i = 0; i < options.points; ++i) {
    if (i % kAtOnce == 0) stage.advance(std::min(kAtOnce, options.points - i));
    const double place = random.uniform() * sums.back();
    // The first sum above it: never a face without area.
    const auto found = std::upper_bound(sums.begin(), sums.end(), place);
    const Triangle& t = triangles[static_cast<std::size_t>(found - sums.begin())];
    // Uniform on the triangle: Osada et al. 2002, equation 1.
    const double root = std::sqrt(random.uniform()), along = random.uniform();
    const Vec3 weights(1.0 - root, root * (1.0 - along), root * along);
    const auto& p = vertices.positions;
    cloud.positions.push_back(weights[0] * p[t[0]] + weights[1] * p[t[1]] + weights[2] * p[t[2]]);
    const auto& n = vertices.normals;
    cloud.normals.push_back(
        options.vertex_normals
            ? Vec3(weights[0] * n[t[0]] + weights[1] * n[t[1]] + weights[2] * n[t[2]])
            : area_vector(p, t));
    if (!vertices.colours.empty()) cloud.colours.push_back(blend(vertices.colours, t, weights));
  }
  make_normals_unit(cloud);
  return cloud;
}

}  // namespace pcednet::shapes
