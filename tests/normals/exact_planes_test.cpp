#include "pcednet/normals/exact_planes.h"
#include "pcednet/core/random_vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "normals/shapes.h"
#include "pcednet/core/parallel.h"
#include "pcednet/normals/estimate.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {
namespace {

/// Points drawn from the surface of the box [0, size], uniform by area.
Shape drawn_box(std::size_t count, const Vec3& size) {
  Random random(5);
  const Vec3 areas(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  Shape shape;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = random.uniform(0.0, areas.sum());
    const int axis = at < areas[0] ? 0 : at < areas[0] + areas[1] ? 1 : 2;
    const bool far = random.index(2) == 1;
    Vec3 p = uniform_vector(random);
    p[axis] = far ? 1.0 : 0.0;
    shape.positions.push_back(p.cwiseProduct(size));
    shape.normals.push_back(far ? Vec3::Unit(axis) : Vec3(-Vec3::Unit(axis)));
  }
  return shape;
}

double share_beyond(double degrees, const Shape& shape, const std::vector<Vec3>& normals) {
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double angle = angle_between_lines(normals[i], shape.normals[i]);
    beyond += angle > degrees * std::numbers::pi / 180;
  }
  return static_cast<double>(beyond) / static_cast<double>(normals.size());
}

TEST(ExactPlanes, GiveSparsePointsTheNormalsOfTheirFaces) {
  const Shape shape = drawn_box(500, Vec3(1.0, 0.4, 0.15));
  EXPECT_GT(share_beyond(5.0, shape, estimate_normals(shape.positions, NeighbourChoice{12})), 0.3);
  EXPECT_LT(share_beyond(5.0, shape, estimate_normals(shape.positions)), 0.1);
}

TEST(ExactPlanes, OfAnEdgeAreBetweenItsFaces) {
  std::vector<Vec3> points = {Vec3::Zero()};
  for (int i = -2; i <= 2; ++i) {
    for (int k = 0; k <= 2; ++k) {
      if (i != 0 || k != 0) points.emplace_back(i, k, 0);
      if (k != 0) points.emplace_back(i, 0, k);
    }
  }
  std::vector<std::uint32_t> nearest(points.size() - 1);
  std::iota(nearest.begin(), nearest.end(), 1u);
  std::stable_sort(nearest.begin(), nearest.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a].squaredNorm() < points[b].squaredNorm();
  });
  const Vec3 normal = exact_normal(points, 0, nearest);
  EXPECT_LT(angle_between_lines(normal, Vec3(0, 1, 1).normalized()), 1e-9);
}

TEST(ExactPlanes, AreNotTakenFromNoiseOrCurvedSurfaces) {
  Shape noisy = drawn_box(2000, Vec3::Ones());
  Random random(6);
  for (Vec3& p : noisy.positions) {
    p += 0.01 * normal_vector(random);
  }
  EXPECT_FALSE(make_neighbour_graph(noisy.positions).choice.exact_planes);
  EXPECT_FALSE(make_neighbour_graph(torus(600, 1.0, 0.4).positions).choice.exact_planes);
}

TEST(ExactPlanes, AreNotTakenFromScanLines) {
  // Every line is in a vertical plane through the scanner; only their heights are rough.
  Random random(7);
  std::vector<Vec3> positions;
  for (int line = 0; line < 60; ++line) {
    const double angle = 0.1 * line;
    for (int i = 0; i < 60; ++i) {
      const double range = 2.0 + 0.03 * i;
      positions.emplace_back(range * std::cos(angle), range * std::sin(angle),
                             0.03 * random.normal());
    }
  }
  EXPECT_FALSE(make_neighbour_graph(positions).choice.exact_planes);
}

TEST(ExactPlanes, AreNotTakenFromTheSweepOfAScanner) {
  // A scanner 2 m above level ground; every column of its beams is in a vertical plane, which noise
  // as large as a third of the spacing fills.
  Random random(8);
  std::vector<Vec3> positions;
  for (int column = 0; column < 150; ++column) {
    const double azimuth = 0.004 * column;
    for (int row = 0; row < 60; ++row) {
      const double elevation = -0.9 + 0.004 * row;
      const double range = -2.0 / std::sin(elevation) + 0.003 * random.normal();
      positions.emplace_back(range * std::cos(elevation) * std::cos(azimuth),
                             range * std::cos(elevation) * std::sin(azimuth),
                             range * std::sin(elevation));
    }
  }
  EXPECT_FALSE(make_neighbour_graph(positions).choice.exact_planes);
}

TEST(ExactPlanes, AreFacesIfTheSurfaceStaysOnOneSide) {
  std::vector<Vec3> points = {Vec3(0, 1, 0)};
  for (int i = -2; i <= 2; ++i) {
    for (int k = 0; k <= 2; ++k) {
      if (i != 0 || k != 1) points.emplace_back(i, k, 0);
      if (k != 0) points.emplace_back(i, 0, -k);
    }
  }
  const auto nearest = [&] {
    std::vector<std::uint32_t> others(points.size() - 1);
    std::iota(others.begin(), others.end(), 1u);
    std::stable_sort(others.begin(), others.end(), [&](std::uint32_t a, std::uint32_t b) {
      return (points[a] - points[0]).squaredNorm() < (points[b] - points[0]).squaredNorm();
    });
    return others;
  };
  EXPECT_TRUE(is_on_face(points, 0, nearest()));
  points.emplace_back(0.5, 1.0, 0.5);  // above the face, where the others are below
  EXPECT_FALSE(is_on_face(points, 0, nearest()));
}

TEST(ExactPlanes, NeedSixteenNeighbours) {
  const Shape shape = drawn_box(16, Vec3(1, 1, 1e-9));
  std::vector<std::uint32_t> others(15);
  std::iota(others.begin(), others.end(), 1u);
  EXPECT_EQ(exact_normal(shape.positions, 0, others), Vec3::Zero());
}

TEST(ExactPlanes, HaveTheSameBytesForAnyOrderAndNumberOfThreads) {
  const Shape shape = drawn_box(500, Vec3(1.0, 0.4, 0.15));
  const auto normals = estimate_normals(shape.positions);
  EXPECT_TRUE(make_neighbour_graph(shape.positions).choice.exact_planes);
  set_thread_count(1);
  EXPECT_EQ(estimate_normals(shape.positions), normals);
  set_thread_count(0);
  std::vector<Vec3> reversed(shape.positions.rbegin(), shape.positions.rend());
  auto of_reversed = estimate_normals(reversed);
  std::reverse(of_reversed.begin(), of_reversed.end());
  EXPECT_EQ(of_reversed, normals);
}

}  // namespace
}  // namespace pcednet::normals
