// What find_lines() does with points and options that are few, wrong or of no use.
#include "pcednet/lines/find_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "lines/made_clouds.h"
#include "pcednet/core/error.h"
#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

namespace pcednet::lines {
namespace {

TEST(FindLines, FindsNoBoundaryWherePointsAreMissing) {
  const Cloud cloud = cube(3000);
  std::vector<Vec3> open;  // without its top
  std::vector<Vec3> normals;
  std::vector<std::uint8_t> classes, partial;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (cloud.positions[i].z() > 0.8) continue;
    open.push_back(cloud.positions[i]);
    normals.push_back(cloud.normals[i]);
    classes.push_back(cloud.classes[i]);
    partial.push_back(cloud.positions[i].z() > 0.4 ? 1 : 0);
  }
  const auto boundaries = [&](std::span<const std::uint8_t> missing) {
    const auto curves =
        find_lines({.positions = open, .normals = normals, .classes = classes, .partial = missing},
                   {.boundaries = true});
    return std::count_if(curves.begin(), curves.end(),
                         [](const Curve& curve) { return curve.edge_class == kBoundary; });
  };
  EXPECT_GT(boundaries({}), 0);
  EXPECT_EQ(boundaries(partial), 0);
}

TEST(FindLines, RefusesWhatIsNoProbability) {
  const Cloud cloud = cube(500);
  EdgePoints points = points_of(cloud);
  for (const float bad : {-0.1f, 1.5f, std::numeric_limits<float>::quiet_NaN()}) {
    const std::vector<float> p(cloud.positions.size(), bad);
    points.p_sharp = p;
    EXPECT_ERROR(ErrorKind::kUsage, find_lines(points));
  }
}

TEST(FindLines, AreCertainAtMostWhereBothProbabilitiesAreLarge) {
  const Cloud cloud = cube(3000);
  EdgePoints points = points_of(cloud);
  std::vector<float> p;
  for (const std::uint8_t its_class : cloud.classes) p.push_back(its_class == kSharpEdge ? 1 : 0);
  points.p_sharp = points.p_smooth = p;
  const auto curves = find_lines(points);
  EXPECT_EQ(curves.size(), 12u);
  for (const Curve& curve : curves) EXPECT_DOUBLE_EQ(curve.confidence, 1.0);
}

TEST(FindLines, FollowsClassesThatWereCorrectedAgainstTheirProbabilities) {
  const Cloud cloud = cube(8000);
  std::vector<float> as_classes, painted;  // the edges above were painted
  std::vector<std::uint8_t> erased = cloud.classes;
  for (std::size_t i = 0; i < erased.size(); ++i) {
    const bool is_upper = cloud.positions[i].z() > 0.7;
    const float p = cloud.classes[i] == kSharpEdge ? 0.9f : 0.02f;
    as_classes.push_back(p);
    painted.push_back(is_upper ? 0.02f : p);
    if (is_upper) erased[i] = kNonEdge;
  }
  EdgePoints points = points_of(cloud);
  points.p_sharp = as_classes;
  EXPECT_EQ(find_lines(points).size(), 12u);
  points.p_sharp = painted;
  const auto curves = find_lines(points);
  EXPECT_EQ(curves.size(), 12u);
  for (const Curve& curve : curves) EXPECT_GT(curve.confidence, 0.5);
  points.p_sharp = as_classes;
  points.classes = erased;
  for (const Curve& curve : find_lines(points)) {
    EXPECT_LT(0.5 * (curve.points.front() + curve.points.back()).z(), 0.7);
  }
}

TEST(FindLines, RefusesACurveOfOtherPoints) {
  const Cloud cloud = cube(500);
  EdgePoints points = points_of(cloud);
  for (const std::vector<std::uint32_t>& curve :
       {std::vector<std::uint32_t>{1, 2, 500}, std::vector<std::uint32_t>(501, 3),
        std::vector<std::uint32_t>(500, 3), std::vector<std::uint32_t>{0, 1, 2}}) {
    points.curve = curve;
    EXPECT_ERROR(ErrorKind::kUsage, find_lines(points));
  }
}

TEST(FindLines, StopAtAnyStepWhenTold) {
  const Cloud cloud = cube(20000);
  const EdgePoints points = points_of(cloud);
  std::set<std::string> steps;
  const Progress watch = {.report = [&](const std::string& step, double) { steps.insert(step); },
                          .cancelled = {}};
  find_lines(points, {}, &watch);
  EXPECT_TRUE(steps.contains("joins") && steps.contains("corners"));
  for (const std::string& last : steps) {
    std::atomic stop = false;
    const Progress stopping = {.report =
                                   [&](const std::string& step, double) {
                                     if (step == last) stop = true;
                                   },
                               .cancelled = [&] { return stop.load(); }};
    EXPECT_ERROR(ErrorKind::kCancelled, find_lines(points, {}, &stopping)) << last;
  }
}

TEST(FindLines, LeaveOutWhatIsTooShort) {
  const Cloud cloud = cube(3000);
  EXPECT_TRUE(lines_of(cloud, {.min_length = 1.1}).empty());
  EXPECT_EQ(lines_of(cloud, {.min_length = 0.9}).size(), 12u);
}

TEST(FindLines, AreNoneWhereThereIsNothingToSee) {
  EXPECT_TRUE(find_lines({}).empty());
  Cloud one;
  one.add({1, 2, 3}, Vec3::UnitZ(), true);
  EXPECT_TRUE(lines_of(one).empty());
  Cloud unplaced;
  for (int i = 0; i < 50; ++i) {
    unplaced.add(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), Vec3::UnitZ(), true);
  }
  EXPECT_TRUE(lines_of(unplaced).empty());
  Cloud one_place;
  for (int i = 0; i < 50; ++i) one_place.add({1, 2, 3}, Vec3::UnitZ(), true);
  EXPECT_TRUE(lines_of(one_place, {.boundaries = true}).empty());
  Cloud without_normals = cube(1000);
  for (Vec3& normal : without_normals.normals) normal.setZero();
  EXPECT_GE(lines_of(without_normals).size(), 10u);  // exact planes need none
  Random random(2);
  for (Vec3& p : without_normals.positions) {
    p += 0.03 * without_normals.spacing * normal_vector(random);
  }
  EXPECT_TRUE(lines_of(without_normals).empty());
  Cloud all_edges = cube(1000);
  std::fill(all_edges.classes.begin(), all_edges.classes.end(), kSharpEdge);
  EXPECT_EQ(lines_of(all_edges).size(), 12u);
}

TEST(FindLines, StayFiniteOnAnyPoints) {
  Random random(5);
  Cloud cloud;
  for (int i = 0; i < 3000; ++i) {
    const double z = i % 3 == 0 ? 0.0 : random.normal(), y = random.normal(), x = random.normal();
    const bool on_edge = random.index(2) == 0;
    cloud.add({x, y, z}, normal_vector(random).normalized(), on_edge);
  }
  for (const Curve& curve : lines_of(cloud, {.regularise = true, .boundaries = true})) {
    EXPECT_TRUE(std::isfinite(length_of(curve)));
    for (const Vec3& point : curve.points) EXPECT_TRUE(point.allFinite());
  }
}

TEST(FindLines, RefuseWhatMakesNoSense) {
  EXPECT_ERROR(ErrorKind::kUsage, find_lines({}, {.gap = -1.0}));
  EXPECT_ERROR(ErrorKind::kUsage, find_lines({}, {.angle = 0.0}));
  EXPECT_ERROR(ErrorKind::kUsage,
               find_lines({}, {.tolerance = std::numeric_limits<double>::infinity()}));
  const Cloud cloud = cube(10);
  EXPECT_ERROR(ErrorKind::kUsage, find_lines({cloud.positions, {}, cloud.classes}, {}));
  const std::vector<float> few(3);
  EXPECT_ERROR(ErrorKind::kUsage,
               find_lines({cloud.positions, cloud.normals, cloud.classes, few}, {}));
}

}  // namespace
}  // namespace pcednet::lines
