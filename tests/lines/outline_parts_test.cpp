#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "lines/made_clouds.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

using Inside = std::function<bool(double x, double y)>;

/// A flat roof of 30 by 20 metres at height 1, less its openings; so many points per square metre.
Cloud flat_roof(double density, const Inside& open, double noise = 0.0) {
  Random random(21);
  Cloud cloud{.spacing = 1.0 / std::sqrt(density)};
  const auto count = static_cast<std::size_t>(600.0 * density);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(0.0, 30.0), y = random.uniform(0.0, 20.0);
    if (open(x, y)) continue;
    const Vec3 jitter = normal_vector(random);
    cloud.add(Vec3(x, y, 1.0) + noise * jitter, Vec3::UnitZ(), false);
  }
  return cloud;
}

std::vector<Curve> roof_edges(const Cloud& cloud) {
  return find_lines({cloud.positions, cloud.normals, cloud.classes}, {.boundaries = true});
}

Inside rectangle(double from_x, double from_y, double to_x, double to_y) {
  return [=](double x, double y) { return x > from_x && x < to_x && y > from_y && y < to_y; };
}

/// Whether each of these places is where so many curves end, and nothing else is.
void expect_corners(const std::vector<Curve>& curves, const std::vector<Eigen::Vector2d>& places,
                    double within) {
  EXPECT_EQ(curves.size(), places.size());
  std::vector<std::size_t> ends(places.size());
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.edge_class, kBoundary);
    for (const Vec3& end : {curve.points.front(), curve.points.back()}) {
      const auto nearest =
          std::min_element(places.begin(), places.end(), [&](const auto& a, const auto& b) {
            return (a - end.head<2>()).norm() < (b - end.head<2>()).norm();
          });
      EXPECT_LT((*nearest - end.head<2>()).norm(), within) << end.transpose();
      ++ends[static_cast<std::size_t>(nearest - places.begin())];
    }
  }
  EXPECT_EQ(std::count(ends.begin(), ends.end(), 2u), static_cast<std::ptrdiff_t>(places.size()));
}

TEST(Openings, HaveTheirEdgesAndCornersAtTheirPoints) {
  for (const double density : {4.0, 20.0}) {
    const double within = 1.0 / std::sqrt(density);
    const auto courtyard = roof_edges(flat_roof(density, rectangle(10.0, 6.0, 20.0, 14.0)));
    expect_corners(courtyard,
                   {{0, 0}, {30, 0}, {30, 20}, {0, 20}, {10, 6}, {20, 6}, {20, 14}, {10, 14}},
                   within);
    const auto u_plan = roof_edges(flat_roof(density, rectangle(10.0, 6.0, 20.0, 21.0)));
    expect_corners(
        u_plan, {{0, 0}, {30, 0}, {30, 20}, {20, 20}, {20, 6}, {10, 6}, {10, 20}, {0, 20}}, within);
  }
}

TEST(Openings, KeepAChamfer) {
  const Inside opening = [](double x, double y) {
    return x > 10.0 && x < 20.0 && y > 6.0 && y < 14.0 && x - 10.0 + y - 6.0 > 1.2;
  };
  expect_corners(
      roof_edges(flat_roof(20.0, opening)),
      {{0, 0}, {30, 0}, {30, 20}, {0, 20}, {11.2, 6}, {20, 6}, {20, 14}, {10, 14}, {10, 7.2}}, 0.3);
}

/// Those that do not follow the border of the roof.
std::vector<Curve> of_openings(std::vector<Curve> curves) {
  std::erase_if(curves, [](const Curve& curve) {
    const auto is_outer = [](const Vec3& p) {
      return std::min({p.x(), p.y(), 30.0 - p.x(), 20.0 - p.y()}) < 1.0;
    };
    return is_outer(curve.points.front()) || is_outer(curve.points.back());
  });
  return curves;
}

TEST(Openings, AreRectanglesInAnyDirection) {
  const double spacing = std::sqrt(1.0 / 20.0);
  int right = 0;
  for (int i = 0; i < 20; ++i) {
    // 13 by 9 spacings or 27 by 22, turned by up to 54 degrees.
    const Eigen::Rotation2Dd turn(i < 5 ? 0.0 : 0.05 * i);
    const Eigen::Vector2d middle(9.0 + 0.6 * i, 8.0 + 0.2 * i);
    const Eigen::Vector2d half = i % 2 == 0 ? Eigen::Vector2d(1.5, 1.0) : Eigen::Vector2d(3.0, 2.5);
    const Inside opening = [&](double x, double y) {
      const Eigen::Vector2d at = turn.inverse() * (Eigen::Vector2d(x, y) - middle);
      return (at.cwiseAbs().array() < half.array()).all();
    };
    const auto sides = of_openings(roof_edges(flat_roof(20.0, opening)));
    const bool at_corners = std::all_of(sides.begin(), sides.end(), [&](const Curve& side) {
      return std::all_of(side.points.begin(), side.points.end(), [&](const Vec3& end) {
        const Eigen::Vector2d at = turn.inverse() * (end.head<2>() - middle);
        return (at.cwiseAbs() - half).norm() < spacing;
      });
    });
    right += sides.size() == 4 && at_corners ? 1 : 0;
  }
  EXPECT_GE(right, 18);
}

TEST(Openings, OfOtherFormsAreNotRectangles) {
  const Inside hexagon = [](double x, double y) {
    const double a = 0.866 * (x - 14.0), b = 0.5 * (y - 9.0);
    return std::max({std::abs(y - 9.0), std::abs(a + b), std::abs(a - b)}) < 3.0;
  };
  EXPECT_EQ(of_openings(roof_edges(flat_roof(20.0, hexagon))).size(), 6u);
  const Inside arch = [](double x, double y) {
    return (std::abs(x - 14.0) < 1.5 && y > 6.0 && y < 9.0) || std::hypot(x - 14.0, y - 9.0) < 1.5;
  };
  EXPECT_GT(of_openings(roof_edges(flat_roof(20.0, arch))).size(), 4u);
}

std::vector<Curve> circles_of(std::vector<Curve> curves) {
  std::erase_if(curves, [](const Curve& curve) { return curve.kind != CurveKind::kCircle; });
  return curves;
}

TEST(Openings, OfCirclesAreCircles) {
  for (const double radius : {1.2, 3.0, 8.0}) {
    const Inside opening = [&](double x, double y) {
      return std::hypot(x - 15.0, y - 10.0) < radius;
    };
    const auto curves = roof_edges(flat_roof(20.0, opening));
    const auto circles = circles_of(curves);
    EXPECT_EQ(curves.size(), 5u) << radius;
    ASSERT_EQ(circles.size(), 1u) << radius;
    EXPECT_LT((circles[0].centre - Vec3(15.0, 10.0, 1.0)).norm(), 0.06);
    EXPECT_NEAR(circles[0].radius, radius, 0.06);
    EXPECT_EQ(circles[0].edge_class, kBoundary);
  }
}

TEST(Openings, OfOctagonsAreNoCircles) {
  const Inside opening = [](double x, double y) {
    const double u = std::abs(x - 15.0), v = std::abs(y - 10.0);
    return std::max({u, v, std::sqrt(0.5) * (u + v)}) < 4.0;
  };
  const auto curves = roof_edges(flat_roof(20.0, opening));
  EXPECT_TRUE(circles_of(curves).empty());
  EXPECT_EQ(curves.size(), 12u);
}

TEST(Outlines, OfRoundRoofsAreCircles) {
  const Inside outside = [](double x, double y) { return std::hypot(x - 15.0, y - 10.0) > 9.0; };
  const auto curves = roof_edges(flat_roof(20.0, outside));
  ASSERT_EQ(curves.size(), 1u);
  ASSERT_EQ(circles_of(curves).size(), 1u);
  EXPECT_LT((curves[0].centre - Vec3(15.0, 10.0, 1.0)).norm(), 0.06);
  EXPECT_NEAR(curves[0].radius, 9.0, 0.06);
}

TEST(Outlines, HaveArcsWhereTheyAreRound) {
  const Inside opening = [](double x, double y) {  // a slot
    return std::hypot(x - std::clamp(x, 10.0, 20.0), y - 10.0) < 3.0;
  };
  std::size_t arcs = 0, segments = 0;
  for (const Curve& curve : roof_edges(flat_roof(20.0, opening))) {
    segments += curve.kind == CurveKind::kSegment;
    if (curve.kind != CurveKind::kArc) continue;
    ++arcs;
    EXPECT_NEAR(curve.radius, 3.0, 0.15);
    EXPECT_NEAR(curve.centre.y(), 10.0, 0.1);
    EXPECT_LT(std::min(std::abs(curve.centre.x() - 10.0), std::abs(curve.centre.x() - 20.0)), 0.2);
  }
  EXPECT_EQ(arcs, 2u);
  EXPECT_EQ(segments, 6u);
}

TEST(Outlines, AreStraightHoweverLongInNoise) {
  const Inside nowhere = [](double, double) { return false; };
  for (const double noise : {0.0, 0.1, 0.2}) {  // spacings
    const double spacing = 1.0 / std::sqrt(60.0);
    const auto curves = roof_edges(flat_roof(60.0, nowhere, noise * spacing));
    expect_corners(curves, {{0, 0}, {30, 0}, {30, 20}, {0, 20}}, (0.3 + 3.0 * noise) * spacing);
  }
}

}  // namespace
}  // namespace pcednet::lines
