#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "workbench/shapes/solids/mesh_samples.h"

namespace pcednet::shapes {
namespace {

/// Two faces, of areas 3 and 1, and one without an area.
struct TwoFaces {
  PointCloud vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 0, 1}, {0, 1, 2}, {0, 2, 3}};
  TwoFaces() {
    vertices.positions = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}};
    vertices.colours = {{0, 0, 0}, {0, 0, 0}, {200, 0, 0}, {0, 0, 0}};
  }
};

TEST(MeshSamples, LieOnTheFacesInProportionToTheirAreas) {
  const TwoFaces mesh;
  const PointCloud cloud = sample_mesh(mesh.vertices, mesh.triangles, {.points = 20000});
  ASSERT_EQ(cloud.size(), 20000u);
  std::size_t first = 0;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    if (cloud.normals[i] == Vec3(0, 0, 1)) {
      ++first;
      sum += p;
      EXPECT_EQ(p.z(), 0.0);
      EXPECT_LE(p.x() / 3 + p.y() / 2, 1.0 + 1e-12);
      EXPECT_NEAR(cloud.colours[i][0], 200 * p.y() / 2, 0.5 + 1e-9);
    } else {
      EXPECT_EQ(cloud.normals[i], Vec3(1, 0, 0));
      EXPECT_EQ(p.x(), 0.0);
    }
  }
  // 15000 expected, with a deviation of 61; the mean is the centroid, its deviation below 0.006.
  EXPECT_NEAR(static_cast<double>(first), 15000.0, 5 * 61.0);
  EXPECT_LT((sum / static_cast<double>(first) - Vec3(1, 2.0 / 3, 0)).norm(), 0.04);
}

TEST(MeshSamples, DependOnTheSeedAlone) {
  const TwoFaces mesh;
  const auto draw = [&](std::uint64_t seed) {
    return sample_mesh(mesh.vertices, mesh.triangles, {.points = 50, .seed = seed}).positions;
  };
  EXPECT_EQ(draw(3), draw(3));
  EXPECT_NE(draw(3), draw(4));
}

TEST(MeshSamples, InterpolateTheNormalsOfVertices) {
  TwoFaces mesh;
  mesh.vertices.normals.assign(4, Vec3(0, 0.6, 0.8));
  for (const Vec3& n :
       sample_mesh(mesh.vertices, mesh.triangles, {.points = 9, .vertex_normals = true}).normals) {
    EXPECT_LT((n - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  }
}

TEST(MeshSamples, NeedAnArea) {
  const TwoFaces mesh;
  EXPECT_ERROR(ErrorKind::kInsufficient, sample_mesh(mesh.vertices, {}));
  EXPECT_ERROR(ErrorKind::kInsufficient,
               sample_mesh(mesh.vertices, std::span(mesh.triangles).first(1)));
  EXPECT_ERROR(ErrorKind::kInsufficient,
               sample_mesh(mesh.vertices, mesh.triangles, {.vertex_normals = true}));
}

}  // namespace
}  // namespace pcednet::shapes
