#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/surfaces/default_shapes.h"
#include "workbench/shapes/surfaces/polyhedra.h"
#include "workbench/shapes/surfaces/sampling.h"

namespace pcednet::shapes {
namespace {

constexpr double kPi = std::numbers::pi;

/// 1/3 of the flux of the position through the surface: the volume of a closed shape whose normals
/// are outwards and whose densities are right. Midpoint rule.
double enclosed_volume(const Shape& shape, int steps = 200) {
  double sum = 0.0;
  for (const SurfacePatch& patch : shape.patches) {
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const SurfacePoint p = patch.at((i + 0.5) / steps, (j + 0.5) / steps);
        sum += p.position.dot(p.normal) * p.density;
      }
    }
  }
  return sum / (3.0 * steps * steps);
}

double distance_to_edges(const Shape& shape, const Vec3& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const EdgeCurve& edge : shape.edges) {
    nearest = std::min(nearest,
                       std::visit([&](const auto& c) { return distance(c, point); }, edge.curve));
  }
  return nearest;
}

/// A corner on the unit sphere gives edge a, and that the textbook volume.
TEST(Shapes, RegularSolidsEncloseTheirVolumes) {
  const double phi = std::numbers::phi;
  const double cube_edge = 2.0 / std::sqrt(3.0);
  const double icosahedron_edge = 2.0 / std::sqrt(phi * phi + 1.0);
  const double dodecahedron_edge = 2.0 / (std::sqrt(3.0) * phi);
  // The midpoint rule is exact here; sums of 10^6 terms leave 1e-11.
  EXPECT_NEAR(enclosed_volume(make_shape(cube())), std::pow(cube_edge, 3), 1e-10);
  EXPECT_NEAR(enclosed_volume(make_shape(icosahedron())),
              5.0 * (3.0 + std::sqrt(5.0)) / 12.0 * std::pow(icosahedron_edge, 3), 1e-10);
  EXPECT_NEAR(enclosed_volume(make_shape(dodecahedron())),
              (15.0 + 7.0 * std::sqrt(5.0)) / 4.0 * std::pow(dodecahedron_edge, 3), 1e-10);
  EXPECT_EQ(make_shape(cube()).edges.size(), 12u);
  EXPECT_EQ(make_shape(icosahedron()).edges.size(), 30u);
  EXPECT_EQ(make_shape(dodecahedron()).edges.size(), 30u);
}

TEST(Shapes, OtherSolidsEncloseTheirVolumes) {
  EXPECT_NEAR(enclosed_volume(four_cubes()), 4.0, 1e-9);
  // The midpoint rule leaves 1e-5 on curved patches.
  EXPECT_NEAR(enclosed_volume(cone_on_plate()), kPi * (0.3 + 0.25 * 1.7 / 3.0), 1e-4);
  const Vec3 inner(0.8, 1.0, 0.7);
  const double r = 0.1;
  EXPECT_NEAR(
      enclosed_volume(rounded_box(r)),
      inner.prod() +
          2.0 * r * (inner.x() * inner.y() + inner.y() * inner.z() + inner.z() * inner.x()) +
          kPi * r * r * inner.sum() + 4.0 / 3.0 * kPi * r * r * r,
      1e-4);
}

/// Pappus: area of the outline times the way of its centroid.
TEST(Shapes, ALoftOfOneOutlineEnclosesWhatPappusSays) {
  const std::vector<Vec2> square = {{1.0, 0.0}, {1.5, 0.0}, {1.5, 0.5}, {1.0, 0.5}};
  const Shape shape = make_shape(Loft{square, square, 2.0});
  EXPECT_NEAR(enclosed_volume(shape), 0.25 * 1.25 * 2.0, 1e-4);
  EXPECT_NEAR(
      surface_area(shape),
      2.0 * 0.25 + 2.0 * 2.0 * 1.25 + 2.0 * 2.0 * 0.5 * 1.25 - 2.5 + 2.0 * 0.5 * (1.0 + 1.5) - 2.5,
      1e-3);
}

TEST(Shapes, NormalsAndDensitiesAreThoseOfTheParametrisation) {
  constexpr double kStep = 1e-6;
  Random random(5);
  for (const Recipe& recipe : default_recipes(3)) {
    for (const SurfacePatch& patch : recipe.shape.patches) {
      for (int i = 0; i < 10; ++i) {
        const double u = random.uniform(0.01, 0.49);
        const double v = random.uniform(0.01, 0.49);
        const SurfacePoint p = patch.at(u, v);
        const Vec3 du = (patch.at(u + kStep, v).position - patch.at(u - kStep, v).position);
        const Vec3 dv = (patch.at(u, v + kStep).position - patch.at(u, v - kStep).position);
        EXPECT_NEAR(p.normal.norm(), 1.0, 1e-12);
        // Central differences leave kStep^2 and rounding / kStep, 1e-9, of these unit-size shapes.
        EXPECT_NEAR(p.normal.dot(du) / du.norm(), 0.0, 1e-7) << recipe.name;
        EXPECT_NEAR(p.normal.dot(dv) / dv.norm(), 0.0, 1e-7) << recipe.name;
        EXPECT_LE(p.density, patch.max_density * (1.0 + 1e-12)) << recipe.name;
      }
    }
  }
}

/// On solids of axis-parallel boxes the nearest surface of another direction begins at an edge.
TEST(Shapes, EdgesOfBoxesAreWhereTheDirectionOfTheSurfaceChanges) {
  Random random(2);
  for (int i = 0; i < 6; ++i) {
    const Shape shape = i == 0 ? four_cubes() : random_blocks(random);
    const SurfaceSamples dense = sample_surface(shape, {.points = 300000}, random);
    std::vector<std::vector<Vec3>> by_axis(3);
    for (std::size_t k = 0; k < dense.positions.size(); ++k) {
      int axis = 0;
      dense.normals[k].cwiseAbs().maxCoeff(&axis);
      by_axis[axis].push_back(dense.positions[k]);
    }
    const std::vector<spatial::KdTree> trees = [&] {
      std::vector<spatial::KdTree> all;
      for (const auto& positions : by_axis) all.emplace_back(positions);
      return all;
    }();
    std::vector<spatial::Neighbour> near;
    for (std::size_t k = 0; k < 2000; ++k) {
      int axis = 0;
      dense.normals[k].cwiseAbs().maxCoeff(&axis);
      double oracle = std::numeric_limits<double>::infinity();
      for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
        trees[other].nearest(dense.positions[k], 1, near);
        oracle = std::min(oracle, std::sqrt(near.front().sq_distance));
      }
      // The samples are 0.008 apart; the nearest one to a given point of the edge is hardly ever
      // farther than six times that.
      EXPECT_LE(distance_to_edges(shape, dense.positions[k]), oracle + 1e-12);
      EXPECT_NEAR(distance_to_edges(shape, dense.positions[k]), oracle, 0.05);
    }
  }
}

/// The chamfer of the fan part (corner 3) is sharp where it starts and gone where it ends.
TEST(Shapes, AnEdgeFadesOut) {
  const Shape shape = fan_part();
  const double angle = 0.6 * kPi;
  const auto strength_at = [&](double u) {
    const double t = u * angle;
    const double z = 0.9 + u * (0.7 - 0.9);
    const double r = 1.8 + u * (1.825 - 1.8);
    const Vec3 point(r * std::cos(t), r * std::sin(t), z);
    EdgeClass strongest = kNonEdge;
    for (const EdgeCurve& edge : shape.edges) {
      const double d = std::visit([&](const auto& c) { return distance(c, point); }, edge.curve);
      if (d < 1e-3) strongest = std::max(strongest, edge.strength);
    }
    return strongest;
  };
  EXPECT_EQ(strength_at(0.05), kSharpEdge);
  EXPECT_EQ(strength_at(0.97), kNonEdge);
  int changes = 0;
  EdgeClass last = kSharpEdge;
  for (double u = 0.05; u < 0.98; u += 0.005) {
    const EdgeClass strength = strength_at(u);
    EXPECT_LE(strength, last);
    changes += strength != last;
    last = strength;
  }
  EXPECT_EQ(changes, 2);
}

TEST(Shapes, DistancesAgreeWithDenseSamplingOfTheCurves) {
  constexpr int kSteps = 20000;
  Random random(7);
  const Arc arc{Vec3(0.2, -0.1, 0.4), Vec3(0.6, 0.8, 0.0), Vec3(0.0, 0.0, 1.0), 0.7, 4.0};
  const Segment segment{Vec3(0.1, 0.2, 0.3), Vec3(0.9, -0.4, 0.5)};
  for (int i = 0; i < 50; ++i) {
    const Vec3 point = uniform_vector(random, -Vec3::Ones(), Vec3::Ones());
    double to_arc = std::numeric_limits<double>::infinity();
    double to_segment = to_arc;
    for (int k = 0; k <= kSteps; ++k) {
      const double s = static_cast<double>(k) / kSteps;
      const double t = s * arc.angle;
      const Vec3 on_arc = arc.centre + arc.radius * (std::cos(t) * arc.x + std::sin(t) * arc.y);
      to_arc = std::min(to_arc, (point - on_arc).norm());
      to_segment = std::min(to_segment, (point - segment.a - s * (segment.b - segment.a)).norm());
    }
    // A sample is at most 7e-5 along the curve from the nearest point.
    EXPECT_NEAR(distance(arc, point), to_arc, 7e-5);
    EXPECT_LE(distance(arc, point), to_arc + 1e-12);
    EXPECT_NEAR(distance(segment, point), to_segment, 7e-5);
    EXPECT_LE(distance(segment, point), to_segment + 1e-12);
  }
}

TEST(Shapes, SamplesCoverTheAreaEvenly) {
  Random random(11);
  const SurfaceSamples samples = sample_surface(cone_on_plate(), {.points = 40000}, random);
  std::size_t on_cone = 0;
  std::size_t under_half = 0;  // on the lower disc, within half its radius: a quarter of it
  std::size_t under = 0;
  for (const Vec3& p : samples.positions) {
    on_cone += p.z() > 0.3 + 1e-9;
    under += p.z() == 0.0;
    under_half += p.z() == 0.0 && p.head<2>().norm() < 0.5;
  }
  const double area = kPi * (1.0 + 2.0 * 0.3 + 0.75 + 0.5 * std::hypot(0.5, 1.7));
  const auto expect_share = [](std::size_t count, std::size_t total, double share) {
    const double deviation = std::sqrt(total * share * (1.0 - share));
    EXPECT_NEAR(static_cast<double>(count), total * share, 4.0 * deviation);
  };
  expect_share(on_cone, 40000, kPi * 0.5 * std::hypot(0.5, 1.7) / area);
  expect_share(under, 40000, kPi / area);
  expect_share(under_half, under, 0.25);
}

TEST(Shapes, EvenSamplesKeepTheirDistance) {
  Random random(12);
  const Shape shape = make_shape(cube());
  const SurfaceSamples samples =
      sample_surface(shape, {.points = 2000, .min_distance = 0.03}, random);
  ASSERT_EQ(samples.positions.size(), 2000u);
  const spatial::KdTree tree(samples.positions);
  std::vector<spatial::Neighbour> near;
  for (const Vec3& p : samples.positions) {
    tree.nearest(p, 2, near);
    EXPECT_GE(near[1].sq_distance, 0.03 * 0.03);
  }
}

}  // namespace
}  // namespace pcednet::shapes
