#include "pcednet/lines/find_lines.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <string>

#include "lines/made_clouds.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random_vectors.h"

namespace pcednet::lines {
namespace {

/// A cylinder of radius 1 and height 1 with both caps.
Cloud cylinder(std::size_t points) {
  Random random(2);
  const double area = 4.0 * std::numbers::pi;
  Cloud cloud{.spacing = std::sqrt(area / static_cast<double>(points))};
  for (std::size_t i = 0; i < points; ++i) {
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    if (random.index(2) == 0) {
      const double z = random.uniform();
      cloud.add(outward + z * Vec3::UnitZ(), outward, std::min(z, 1.0 - z) < kNear * cloud.spacing);
    } else {
      const double radius = std::sqrt(random.uniform()), z = random.index(2) == 0 ? 0.0 : 1.0;
      cloud.add(radius * outward + z * Vec3::UnitZ(), (2.0 * z - 1.0) * Vec3::UnitZ(),
                1.0 - radius < kNear * cloud.spacing);
    }
  }
  return cloud;
}

Cloud sheet(std::size_t points) {
  Random random(3);
  Cloud cloud{.spacing = std::sqrt(1.0 / static_cast<double>(points))};
  for (std::size_t i = 0; i < points; ++i) {
    cloud.add({random.uniform(), random.uniform(), 0.0}, Vec3::UnitZ(), false);
  }
  return cloud;
}

bool same(const Curve& a, const Curve& b) {
  return a.kind == b.kind && a.edge_class == b.edge_class && a.points == b.points &&
         a.closed == b.closed && a.centre == b.centre && a.axis == b.axis && a.radius == b.radius &&
         a.confidence == b.confidence && a.support == b.support;
}

bool same(const std::vector<Curve>& a, const std::vector<Curve>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Curve& x, const Curve& y) { return same(x, y); });
}

TEST(FindLines, GivesACubeItsTwelveEdgesAndEightCorners) {
  const Cloud cloud = cube(6000);
  const auto curves = lines_of(cloud);
  ASSERT_EQ(curves.size(), 12u);
  std::vector<Vec3> corners;
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.kind, CurveKind::kSegment);
    EXPECT_EQ(curve.edge_class, kSharpEdge);
    EXPECT_NEAR(length_of(curve), 1.0, 0.2 * cloud.spacing);
    EXPECT_NEAR(curve.dihedral_angle, 0.5 * std::numbers::pi, 0.08);
    EXPECT_GT(curve.support, 10u);
    EXPECT_EQ(curve.confidence, 1.0);
    for (const Vec3& end : curve.points) {
      const Vec3 rounded = end.array().round();
      EXPECT_LT((end - rounded).norm(), 0.15 * cloud.spacing);
      corners.push_back(end);
    }
  }
  for (const Vec3& corner : corners) {  // three curves share each to the last bit
    EXPECT_EQ(std::count(corners.begin(), corners.end(), corner), 3);
  }
}

TEST(FindLines, GivesThemInNoiseAndTurned) {
  // Of the normals of two faces neither side of the right angle is chosen by rounding.
  for (const double angle : {0.0, 0.7}) {
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
    Cloud cloud = cube(30000);
    Random random(5);
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
      const Vec3 noise = 0.3 * cloud.spacing * normal_vector(random);
      cloud.positions[i] = turn * (cloud.positions[i] + noise);
      cloud.normals[i] = turn * cloud.normals[i];
    }
    const auto curves = lines_of(cloud);
    EXPECT_EQ(curves.size(), 12u);
    double length = 0.0;
    for (const Curve& curve : curves) length += length_of(curve);
    EXPECT_NEAR(length, 12.0, 0.1);
  }
}

TEST(FindLines, GivesAcuteEdgesInNoise) {
  // The faces of a roof of 40 degrees face away from each other, as the sides of a thin wall do.
  const double half = 20.0 * std::numbers::pi / 180.0;
  Random random(5);
  Cloud cloud{.spacing = std::sqrt(2.0 / 20000.0)};
  for (int i = 0; i < 20000; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0, x = random.uniform(), away = random.uniform();
    const Vec3 noise = 0.3 * cloud.spacing * normal_vector(random);
    cloud.add(Vec3(x, away * std::cos(half), away * side * std::sin(half)) + noise,
              Vec3(0.0, -std::sin(half), side * std::cos(half)), away < kNear * cloud.spacing);
  }
  const auto curves = lines_of(cloud);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].kind, CurveKind::kSegment);
  EXPECT_NEAR(length_of(curves[0]), 1.0, 2.0 * cloud.spacing);
  for (const Vec3& end : curves[0].points) {
    EXPECT_LT(std::hypot(end.y(), end.z()), 0.5 * cloud.spacing);
  }
}

TEST(FindLines, RecognisesCirclesToATenthOfASpacing) {
  const Cloud cloud = cylinder(8000);
  const auto curves = lines_of(cloud);
  ASSERT_EQ(curves.size(), 2u);
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.kind, CurveKind::kCircle);
    EXPECT_TRUE(curve.closed);
    EXPECT_NEAR(curve.radius, 1.0, 0.1 * cloud.spacing);
    EXPECT_LT(std::hypot(curve.centre.x(), curve.centre.y()), 0.1 * cloud.spacing);
    EXPECT_NEAR(std::abs(curve.axis.z()), 1.0, 1e-3);
  }
}

TEST(FindLines, DrawsBoundariesOnDemand) {
  const Cloud cloud = sheet(2500);
  EXPECT_TRUE(lines_of(cloud).empty());
  const auto curves = lines_of(cloud, {.boundaries = true});
  ASSERT_EQ(curves.size(), 4u);
  for (const Curve& curve : curves) {
    EXPECT_EQ(curve.edge_class, kBoundary);
    for (const Vec3& end : curve.points) {
      const Vec3 rounded = end.array().round();
      EXPECT_LT((end - rounded).norm(), 0.6 * cloud.spacing);
    }
  }
}

TEST(FindLines, DrawsNoBoundariesOtherwise) {
  Cloud cloud = cube(6000);  // around whose floor points are called boundary
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (cloud.positions[i].z() < cloud.spacing) cloud.classes[i] = kBoundary;
  }
  const auto curves = lines_of(cloud);
  EXPECT_GE(curves.size(), 8u);
  for (const Curve& curve : curves) EXPECT_NE(curve.edge_class, kBoundary);
}

TEST(FindLines, TakesEachStepOnce) {
  const Cloud cloud = cube(20000);
  std::vector<std::string> steps;
  double last = 0.0;
  const Progress watch = {.report =
                              [&](const std::string& step, double done) {
                                if (steps.empty() || steps.back() != step)
                                  steps.push_back(step);
                                else
                                  EXPECT_GE(done, last) << step;
                                last = done;
                              },
                          .cancelled = {}};
  find_lines({cloud.positions, cloud.normals, cloud.classes}, {.boundaries = true}, &watch);
  const std::set<std::string> different(steps.begin(), steps.end());
  EXPECT_EQ(steps.size(), different.size());
}

TEST(FindLines, AreTheSameForAnyThreadsAndOrderAndSignsOfNormals) {
  Cloud cloud = cylinder(4000);
  Random disturbance(8);
  const auto blow = [&]() -> Vec3 {
    return 0.1 * Vec3(disturbance.normal(), disturbance.normal(), disturbance.normal());
  };
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    cloud.positions[i] += cloud.spacing * blow();
    cloud.normals[i] = (cloud.normals[i] + blow()).normalized();
  }
  const LineOptions options = {.boundaries = true};
  set_thread_count(1);
  const auto curves = lines_of(cloud, options);
  for (const int threads : {2, 8}) {
    set_thread_count(threads);
    EXPECT_TRUE(same(lines_of(cloud, options), curves)) << threads;
  }
  set_thread_count(0);
  Cloud shuffled = cloud;
  std::vector<std::size_t> order(cloud.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(4);
  random.shuffle(std::span(order));
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.positions[i] = cloud.positions[order[i]];
    shuffled.normals[i] = (random.index(2) == 0 ? 1.0 : -1.0) * cloud.normals[order[i]];
    shuffled.classes[i] = cloud.classes[order[i]];
  }
  EXPECT_TRUE(same(lines_of(shuffled, options), curves));
}

TEST(FindLines, FollowTheCloudToANationalGrid) {
  const Cloud cloud = cube(3000);
  const auto curves = lines_of(cloud);
  const Vec3 shift(652000.0, 5400000.0, 300.0);
  Cloud moved = cloud;
  for (Vec3& position : moved.positions) position += shift;
  const auto there = lines_of(moved);
  ASSERT_EQ(there.size(), curves.size());
  for (const Curve& curve : there) {  // the order along the curve may be another
    const bool found = std::any_of(curves.begin(), curves.end(), [&](const Curve& other) {
      const Vec3 a = curve.points.front() - shift, b = curve.points.back() - shift;
      const Vec3 &c = other.points.front(), &d = other.points.back();
      return std::min((a - c).norm() + (b - d).norm(), (a - d).norm() + (b - c).norm()) < 1e-3;
    });
    EXPECT_TRUE(found);
  }
}

TEST(FindLines, AreTheSameElsewhereThoughDistancesAreEqualByRounding) {
  Cloud cloud = cube(20000);
  for (Vec3& position : cloud.positions) position = (64.0 * position).array().round() / 64.0;
  const auto curves = lines_of(cloud);
  ASSERT_GE(curves.size(), 8u);
  const Vec3 shift(524288.0, 5242880.0, 512.0);  // keeps every digit
  Cloud moved = cloud;
  for (Vec3& position : moved.positions) position += shift;
  const auto there = lines_of(moved);
  ASSERT_EQ(there.size(), curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    ASSERT_EQ(there[i].points.size(), curves[i].points.size());
    for (std::size_t k = 0; k < curves[i].points.size(); ++k) {
      EXPECT_LT((there[i].points[k] - shift - curves[i].points[k]).norm(), 1e-8);
    }
  }
}

TEST(FindLines, RegulariseMakesRightAnglesExact) {
  const auto curves = lines_of(cube(3000), {.regularise = true});
  ASSERT_EQ(curves.size(), 12u);
  for (const Curve& a : curves) {
    for (const Curve& b : curves) {
      const Vec3 u = (a.points[1] - a.points[0]).normalized();
      const Vec3 v = (b.points[1] - b.points[0]).normalized();
      const double cosine = std::abs(u.dot(v));
      EXPECT_LT(std::min(cosine, 1.0 - cosine), 1e-12);
    }
  }
}

TEST(FindLines, GiveTheAngleBetweenTheSurfaces) {
  const auto straight = lines_of(cube(6000)), round = lines_of(cylinder(6000));
  ASSERT_EQ(straight.size(), 12u);
  ASSERT_FALSE(round.empty());
  for (const Curve& curve : straight) {
    EXPECT_NEAR(curve.dihedral_angle, 0.5 * std::numbers::pi, 0.01);
  }
  for (const Curve& curve : round) {
    EXPECT_NEAR(curve.dihedral_angle, 0.5 * std::numbers::pi, 0.02);
  }
}

TEST(FindLines, LeavesOutShortCurvesAfterTheyWereJoined) {
  const auto all = lines_of(cube(3000), {.min_length = 1e-9});
  for (const double least : {0.2, 0.5, 0.9, 1.1}) {
    const auto wanted = std::count_if(
        all.begin(), all.end(), [&](const Curve& curve) { return length_of(curve) >= least; });
    EXPECT_EQ(static_cast<std::ptrdiff_t>(lines_of(cube(3000), {.min_length = least}).size()),
              wanted);
  }
}

TEST(FindLines, TakesOneOfSeveralPointsAtOnePlaceByTheirValues) {
  Cloud cloud = cube(3000);
  const std::size_t count = cloud.positions.size();
  for (std::size_t i = 0; i < count; ++i) {  // a copy of each that says the contrary
    cloud.positions.push_back(cloud.positions[i]);
    cloud.normals.push_back(cloud.normals[i]);
    cloud.classes.push_back(std::uint8_t{kNonEdge});
  }
  const auto curves = lines_of(cloud, {});
  for (auto* values : {&cloud.positions, &cloud.normals}) {
    std::reverse(values->begin(), values->end());
  }
  std::reverse(cloud.classes.begin(), cloud.classes.end());
  EXPECT_TRUE(same(lines_of(cloud, {}), curves));
  EXPECT_EQ(curves.size(), 12u);
}

TEST(FindLines, CanBeLookedAtStepByStep) {
  const Cloud cloud = cube(20000);
  const auto at = [&](LineStage stage) { return lines_of(cloud, {.stage = stage}); };
  const auto edges = static_cast<std::size_t>(
      std::count(cloud.classes.begin(), cloud.classes.end(), std::uint8_t{kSharpEdge}));
  const std::vector<Curve> creases = at(LineStage::kCreases);
  EXPECT_GT(creases.size(), edges / 2);
  EXPECT_LT(creases.size(), cloud.positions.size() / 2);
  for (const Curve& crease : creases) {
    EXPECT_EQ(crease.kind, CurveKind::kSegment);
    EXPECT_LT(length_of(crease), 4.0 * cloud.spacing);
  }
  const std::vector<Curve> chains = at(LineStage::kChains), pieces = at(LineStage::kPieces);
  EXPECT_GE(chains.size(), 4u);
  for (const Curve& chain : chains) EXPECT_EQ(chain.kind, CurveKind::kPolyline);
  EXPECT_EQ(pieces.size(), 12u);
  for (const Curve& piece : pieces) {
    EXPECT_EQ(piece.kind, CurveKind::kSegment);
    EXPECT_NEAR(length_of(piece), 1.0, 10.0 * cloud.spacing);
    EXPECT_NE(length_of(piece), length_of(at(LineStage::kCurves).front())) << "it met no corner";
  }
}

}  // namespace
}  // namespace pcednet::lines
