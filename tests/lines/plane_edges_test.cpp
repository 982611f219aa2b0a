#include "pcednet/lines/roofs/plane_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/lines/find_lines.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/lines/roofs/faces.h"
#include "support/expect_error.h"

namespace pcednet::lines {
namespace {

/// Points without labels, normals up.
struct PlainCloud {
  std::vector<Vec3> positions = {};
  std::vector<Vec3> normals = {};
  std::vector<std::uint8_t> classes = {};

  void add(const Vec3& position) {
    positions.push_back(position);
    normals.push_back(Vec3::UnitZ());
    classes.push_back(kNonEdge);
  }
  EdgePoints points() const { return {positions, normals, classes}; }
};

std::vector<Curve> roof_lines(const PlainCloud& cloud) {
  return find_lines(cloud.points(), {.boundaries = true});
}

constexpr double kLength = 10.0, kWidth = 6.0;

/// Points uniform in plan on a hip roof of this slope, with noise: z is the slope times the
/// distance to the nearest eaves.
PlainCloud hip_roof(std::size_t points, double slope, double noise) {
  Random random(11);
  PlainCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = random.uniform(0.0, kLength), y = random.uniform(0.0, kWidth);
    const double inside = std::min({x, kLength - x, y, kWidth - y});
    cloud.add({x, y, slope * inside + noise * random.normal()});
  }
  return cloud;
}

std::vector<Vec3> hip_corners(double slope) {
  const double half = 0.5 * kWidth, z = slope * half;
  return {{0, 0, 0},      {kLength, 0, 0}, {kLength, kWidth, 0},
          {0, kWidth, 0}, {half, half, z}, {kLength - half, half, z}};
}

/// Each place that ends of curves share, and how many do.
std::map<std::vector<double>, int> corners_of(const std::vector<Curve>& curves) {
  std::map<std::vector<double>, int> corners;
  for (const Curve& curve : curves) {
    for (const Vec3& end : {curve.points.front(), curve.points.back()}) {
      ++corners[{end.x(), end.y(), end.z()}];
    }
  }
  return corners;
}

TEST(PlaneEdges, DrawASparseHipRoofWithItsSixCorners) {
  for (const double slope : {0.15, 0.5, 1.5}) {  // from 9 degrees
    const auto curves = roof_lines(hip_roof(700, slope, 0.005));
    ASSERT_EQ(curves.size(), 9u) << slope;
    EXPECT_EQ(std::count_if(curves.begin(), curves.end(),
                            [](const Curve& curve) { return curve.edge_class == kBoundary; }),
              4);
    const auto corners = corners_of(curves);
    ASSERT_EQ(corners.size(), 6u) << slope;
    for (const auto& [at, curves_there] : corners) {
      EXPECT_EQ(curves_there, 3);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& corner : hip_corners(slope)) {
        nearest = std::min(nearest, (corner - Vec3(at[0], at[1], at[2])).norm());
      }
      EXPECT_LT(nearest, 0.15) << slope;  // half a spacing
    }
  }
}

TEST(PlaneEdges, StopAtEavesWhenTold) {
  const PlainCloud cloud = hip_roof(700, 0.5, 0.005);
  std::atomic stop = false;
  const Progress stopping = {.report =
                                 [&](const std::string& step, double) {
                                   if (step == "eaves") stop = true;
                                 },
                             .cancelled = [&] { return stop.load(); }};
  EXPECT_ERROR(ErrorKind::kCancelled, find_lines(cloud.points(), {.boundaries = true}, &stopping));
}

TEST(PlaneEdges, KeepTheirDihedralAngle) {
  const double slope = 0.5;
  const auto curves = roof_lines(hip_roof(700, slope, 0.005));
  EXPECT_EQ(std::count_if(curves.begin(), curves.end(),
                          [](const Curve& curve) { return curve.edge_class == kSharpEdge; }),
            5);
  for (const Curve& curve : curves) {
    if (curve.edge_class != kSharpEdge) continue;
    const bool ridge = std::abs(curve.points[0].z() - curve.points[1].z()) < 0.1;
    const double cosine = (ridge ? 1.0 - slope * slope : 1.0) / (1.0 + slope * slope);
    EXPECT_NEAR(curve.dihedral_angle, std::acos(cosine), 0.02);
  }
}

bool same_lines(const std::vector<Curve>& a, const std::vector<Curve>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Curve& x, const Curve& y) {
    return x.points == y.points && x.edge_class == y.edge_class && x.support == y.support &&
           x.confidence == y.confidence && x.dihedral_angle == y.dihedral_angle;
  });
}

TEST(PlaneEdges, AreTheSameForAnyThreadsAndOrderAndSignsOfNormals) {
  const PlainCloud cloud = hip_roof(1500, 0.4, 0.01);
  set_thread_count(1);
  const auto expected = roof_lines(cloud);
  set_thread_count(3);
  EXPECT_TRUE(same_lines(roof_lines(cloud), expected));
  Random random(5);
  std::vector<std::size_t> order(cloud.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(std::span(order));
  PlainCloud shuffled;
  for (const std::size_t i : order) {
    shuffled.add(cloud.positions[i]);
    if (random.index(2) == 0) shuffled.normals.back() *= -1.0;
  }
  EXPECT_TRUE(same_lines(roof_lines(shuffled), expected));
  set_thread_count(0);
}

TEST(PlaneEdges, FollowTheCloudToANationalGrid) {
  const PlainCloud cloud = hip_roof(700, 0.5, 0.005);
  const Vec3 grid(2600000.0, 1200000.0, 400.0);
  PlainCloud moved;
  for (const Vec3& position : cloud.positions) moved.add(position + grid);
  const auto near = roof_lines(cloud), far = roof_lines(moved);
  ASSERT_EQ(near.size(), far.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    EXPECT_LT((near[i].points[0] + grid - far[i].points[0]).norm(), 1e-6);
    EXPECT_LT((near[i].points[1] + grid - far[i].points[1]).norm(), 1e-6);
  }
}

TEST(PlaneEdges, AreForSurfacesSeenFromAbove) {
  PlainCloud cloud = hip_roof(700, 0.5, 0.005);
  const auto found = [&] {
    const OrderedPoints points(cloud.points());
    return find_plane_edges(points, measure_sampling(points), nullptr).has_value();
  };
  EXPECT_TRUE(found());
  for (std::size_t i = 0; i < 700; ++i) {  // a floor
    cloud.add({cloud.positions[i].y() / kWidth * kLength, cloud.positions[i].x() / kLength * kWidth,
               -5.0});
  }
  EXPECT_FALSE(found());
}

TEST(PlaneEdges, AreNotForThinPlates) {
  for (const double spacings : {1.0, 2.0}) {
    Random random(6);
    PlainCloud plate;
    const double spacing = std::sqrt(2.0 * kLength * kWidth / 4000.0);
    for (int i = 0; i < 4000; ++i) {
      const bool top = random.index(2) == 0;
      const double x = random.uniform(0.0, kLength);
      plate.add({x, random.uniform(0.0, kWidth), top ? spacings * spacing : 0.0});
      if (!top) plate.normals.back() *= -1.0;
    }
    const OrderedPoints points(plate.points());
    EXPECT_FALSE(find_plane_edges(points, measure_sampling(points), nullptr)) << spacings;
  }
}

TEST(PlaneEdges, AreNotOfADomeOnLevelGround) {
  Random random(6);
  PlainCloud cloud;
  constexpr double kRadius = 18.0;
  for (int i = 0; i < 130; ++i) {
    for (int j = 0; j < 130; ++j) {
      const double x = i - 65.0, y = j - 60.0;
      const double sq_height = kRadius * kRadius - x * x - y * y;
      cloud.add({x, y, (sq_height > 0.0 ? std::sqrt(sq_height) : 0.0) + 0.15 * random.normal()});
    }
  }
  for (const Curve& curve : roof_lines(cloud)) {
    for (const Vec3& place : curve.points) EXPECT_LT(place.z(), 0.7 * kRadius);
  }
}

TEST(PlaneEdges, OfAStepAreTheUpperOnes) {
  Random random(3);
  PlainCloud cloud;
  for (int i = 0; i < 900; ++i) {
    const double x = random.uniform(0.0, 10.0);
    cloud.add({x, random.uniform(0.0, 6.0), x < 5.0 ? 0.0 : 2.0});
  }
  std::size_t upper = 0;
  for (const Curve& curve : roof_lines(cloud)) {
    const Vec3 middle = 0.5 * (curve.points[0] + curve.points[1]);
    if (std::abs(middle.x() - 5.0) > 1.0) continue;
    EXPECT_NEAR(middle.z(), 2.0, 0.01);
    ++upper;
  }
  EXPECT_EQ(upper, 1u);
}

/// The share of a cloud of plane faces, as found.
double share_of(const PlainCloud& cloud) {
  const OrderedPoints points(cloud.points());
  return find_faces(points, measure_sampling(points), nullptr).share;
}

TEST(Faces, AreNotThePartsOfACurvedSurface) {
  for (const std::size_t count : {1000u, 20000u}) {
    Random random(4);
    PlainCloud sphere;
    for (std::size_t i = 0; i < count; ++i) {
      sphere.add(normal_vector(random).normalized());
    }
    EXPECT_LT(share_of(sphere), 0.2) << count;
    PlainCloud cylinder;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      cylinder.add({std::cos(angle), std::sin(angle), random.uniform(0.0, 3.0)});
    }
    EXPECT_LT(share_of(cylinder), 0.5) << count;
    EXPECT_GT(share_of(hip_roof(count, 0.4, 0.01)), 0.98) << count;
  }
}

TEST(Faces, AreNotThePartsOfHills) {
  for (const std::size_t count : {700u, 2000u, 10000u}) {
    for (const double noise : {0.0, 0.05, 0.2}) {  // spacings
      Random random(count);
      PlainCloud hills;
      for (std::size_t i = 0; i < count; ++i) {
        const double x = random.uniform(), y = random.uniform();
        hills.add({x, y,
                   0.06 * std::sin(6.0 * x) * std::cos(8.0 * y) +
                       noise * random.normal() / std::sqrt(static_cast<double>(count))});
      }
      EXPECT_LT(share_of(hills), 0.9) << count << " points, noise " << noise;
    }
  }
}

TEST(Faces, HaveThePointsOfTheirPlanes) {
  const PlainCloud cloud = hip_roof(1000, 0.4, 0.0);
  const OrderedPoints points(cloud.points());
  const Faces faces = find_faces(points, measure_sampling(points), nullptr);
  ASSERT_EQ(faces.faces.size(), 4u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NE(faces.of_points[i], kNoFace);
    EXPECT_LE(std::abs(faces.faces[faces.of_points[i]].height(points.position(i))), faces.within);
  }
}

TEST(Faces, AreNoneOfTooFewPoints) {
  for (const std::size_t count : {0u, 1u, 5u, 9u}) {
    EXPECT_EQ(share_of(hip_roof(count, 0.4, 0.0)), 0.0);
    EXPECT_TRUE(roof_lines(hip_roof(count, 0.4, 0.0)).empty());
  }
  PlainCloud row;
  for (int i = 0; i < 100; ++i) row.add({0.1 * i, 0.0, 0.0});
  EXPECT_EQ(share_of(row), 0.0);
}

/// Points in random order along x, in a band of this width.
PlainCloud band(std::size_t points, double width) {
  Random random(9);
  PlainCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = random.uniform(0.0, static_cast<double>(points));
    cloud.add({x, random.uniform(0.0, width), 0.01 * random.normal()});
  }
  return cloud;
}

TEST(Faces, AreNoneOfACableThatHangsBesideOne) {
  PlainCloud cloud = hip_roof(1000, 0.4, 0.0);
  for (const Vec3& place : band(1000, 2.0).positions) {
    cloud.add({0.2 * place.x() - 100.0, -20.0 + 0.2 * place.y(), 5.0 + 0.2 * place.z()});
  }
  const OrderedPoints points(cloud.points());
  const Faces faces = find_faces(points, measure_sampling(points), nullptr);
  EXPECT_EQ(faces.faces.size(), 4u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(faces.of_points[i] == kNoFace, points.position(i).y() < -10.0);
  }
}

TEST(Faces, StopWhenTold) {
  const PlainCloud cloud = hip_roof(1000, 0.4, 0.0);
  const OrderedPoints points(cloud.points());
  std::atomic grows = false;
  const Progress stopping = {
      .report = [&](const std::string&, double fraction) { grows = fraction >= 1.0; },
      .cancelled = [&] { return grows.load(); }};
  EXPECT_ERROR(ErrorKind::kCancelled, find_faces(points, measure_sampling(points), &stopping));
}

TEST(Faces, MaySagALittle) {
  PlainCloud cloud = hip_roof(700, 0.5, 0.005);
  for (Vec3& place : cloud.positions) place.z() += 0.03 * std::sin(1.2 * place.x());
  EXPECT_GT(share_of(cloud), 0.95);
  EXPECT_EQ(roof_lines(cloud).size(), 9u);
}

/// A gable of this slope with its ridge along x, as beams of 20 cm see it: every height is the mean
/// over those parts of the beam that meet the roof.
PlainCloud gable_seen_by_beams(double slope) {
  Random random(17);
  PlainCloud cloud;
  while (cloud.positions.size() < 700) {
    const double x = random.uniform(0.0, kLength), y = random.uniform(0.0, kWidth);
    double sum = 0.0, rays = 0.0;
    for (double aside = -0.2; aside < 0.21; aside += 0.05) {
      const double at = y + aside;
      if (at < 0.0 || at > kWidth) continue;
      sum += slope * std::min(at, kWidth - at);
      rays += 1.0;
    }
    cloud.add({x, y, sum / rays + 0.005 * random.normal()});
  }
  return cloud;
}

TEST(PlaneEdges, AreWhereBeamsMeetThemHalf) {
  const double slope = 2.0;
  std::size_t eaves = 0, ridges = 0;
  for (const Curve& curve : roof_lines(gable_seen_by_beams(slope))) {
    const Vec3 middle = 0.5 * (curve.points[0] + curve.points[1]);
    if (std::abs(middle.y() - 0.5 * kWidth) < 0.5 * kWidth - 0.5) {
      if (curve.edge_class != kSharpEdge) continue;
      EXPECT_NEAR(middle.z(), 0.5 * slope * kWidth, 0.1);
      ++ridges;
    } else {
      EXPECT_LT(std::abs(std::abs(middle.y() - 0.5 * kWidth) - 0.5 * kWidth), 0.05);
      ++eaves;
    }
  }
  EXPECT_EQ(eaves, 2u);
  EXPECT_EQ(ridges, 1u);
}

TEST(PlaneEdges, AreBeyondTheLastOfRows) {
  Random random(8);
  PlainCloud cloud;
  for (int i = 0; i < 700; ++i) {
    cloud.add({0.5 * static_cast<double>(random.index(20)), random.uniform(0.0, kWidth), 0.0});
  }
  double from = 0.0, to = 0.0;
  for (const Curve& curve : roof_lines(cloud)) {
    for (const Vec3& place : curve.points) {
      from = std::min(from, place.x());
      to = std::max(to, place.x());
    }
  }
  for (const double beyond : {-from, to - 9.5}) {
    EXPECT_GT(beyond, 0.08);
    EXPECT_LT(beyond, 0.25);
  }
}

}  // namespace
}  // namespace pcednet::lines
