#include "pcednet/eval/line_scores.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "pcednet/core/error.h"
#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

namespace pcednet::eval {
namespace {

using lines::Curve;
using lines::CurveKind;

Curve polyline(std::vector<Vec3> points, bool closed = false) {
  Curve curve;
  curve.points = std::move(points);
  curve.closed = closed;
  return curve;
}

Curve circle(const Vec3& centre, double radius) {
  Curve curve;
  curve.kind = CurveKind::kCircle;
  curve.points = {centre + Vec3(radius, 0, 0)};
  curve.closed = true;
  curve.centre = centre;
  curve.radius = radius;
  return curve;
}

/// The edges of the cube [-1, 1]^3.
std::vector<Curve> cube_edges() {
  std::vector<Curve> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 4; ++side) {
      Vec3 a;
      a[axis] = -1.0;
      a[(axis + 1) % 3] = side & 1 ? 1.0 : -1.0;
      a[(axis + 2) % 3] = side & 2 ? 1.0 : -1.0;
      Vec3 b = a;
      b[axis] = 1.0;
      edges.push_back(polyline({a, b}));
    }
  }
  return edges;
}

std::vector<Curve> shifted(std::vector<Curve> curves, const Vec3& by) {
  for (Curve& curve : curves) {
    for (Vec3& p : curve.points) p += by;
  }
  return curves;
}

TEST(LineScores, OfTheTruthArePerfect) {
  std::vector<Curve> truth = cube_edges();
  truth.push_back(circle({0, 0, 1}, 0.5));
  const LineScores scores = score_lines(truth, truth, {});
  EXPECT_NEAR(scores.chamfer, 0.0, 1e-15);
  EXPECT_NEAR(scores.hausdorff, 0.0, 1e-9);
  for (const double score : {scores.fine_precision, scores.fine_recall, scores.precision,
                             scores.recall, scores.found, scores.pieces, scores.corners}) {
    EXPECT_DOUBLE_EQ(score, 1.0);
  }
  EXPECT_EQ(scores.lines, 13u);
  EXPECT_EQ(scores.true_curves, 13u);
}

TEST(LineScores, OfHalvesAreTwoPiecesAndNothingFound) {
  const std::vector<Curve> truth = {polyline({{-1, 0, 0}, {1, 0, 0}})};
  const std::vector<Curve> halves = {polyline({{-1, 0, 0}, {0, 0, 0}}),
                                     polyline({{0, 0, 0}, {1, 0, 0}})};
  const LineScores scores = score_lines(halves, truth, {});
  EXPECT_DOUBLE_EQ(scores.precision, 1.0);
  EXPECT_DOUBLE_EQ(scores.recall, 1.0);
  EXPECT_DOUBLE_EQ(scores.found, 0.0);
  EXPECT_DOUBLE_EQ(scores.pieces, 2.0);
  // Three corners, two of them true; both true ones found.
  EXPECT_NEAR(scores.corners, 2.0 * (2.0 / 3.0) / (2.0 / 3.0 + 1.0), 1e-12);
}

TEST(LineScores, MeasureAKnownShift) {
  const std::vector<Curve> truth = {polyline({{-1, 0, 0}, {1, 0, 0}})};
  const LineScores near = score_lines(shifted(truth, {0, 0.015, 0}), truth, {});
  EXPECT_NEAR(near.chamfer, 2.0 * 0.015 * 0.015, 1e-12);
  EXPECT_NEAR(near.hausdorff, 0.015, 1e-12);
  EXPECT_DOUBLE_EQ(near.fine_precision, 0.0);
  EXPECT_DOUBLE_EQ(near.fine_recall, 0.0);
  EXPECT_DOUBLE_EQ(near.precision, 1.0);
  EXPECT_DOUBLE_EQ(near.recall, 1.0);
  EXPECT_DOUBLE_EQ(near.found, 1.0);
  EXPECT_DOUBLE_EQ(near.corners, 1.0);
  const LineScores far = score_lines(shifted(truth, {0, 0.031, 0}), truth, {});
  EXPECT_DOUBLE_EQ(far.precision, 0.0);
  EXPECT_DOUBLE_EQ(far.recall, 0.0);
  EXPECT_DOUBLE_EQ(far.found, 0.0);
  EXPECT_DOUBLE_EQ(far.corners, 0.0);
  EXPECT_TRUE(std::isnan(far.pieces));
}

TEST(LineScores, ShareByLengthNotByNumber) {
  const std::vector<Curve> truth = {polyline({{-1, 0, 0}, {1, 0, 0}}),
                                    polyline({{0, 0.5, 0}, {0, 1, 0}})};
  const std::vector<Curve> found = {truth[0], polyline({{-1, -1, 0}, {-1, -0.5, 0}})};
  const LineScores scores = score_lines(found, truth, {});
  EXPECT_NEAR(scores.precision, 2.0 / 2.5, 1e-9);
  EXPECT_NEAR(scores.recall, 2.0 / 2.5, 1e-9);
  EXPECT_DOUBLE_EQ(scores.found, 0.5);
  EXPECT_DOUBLE_EQ(scores.pieces, 1.0);  // of the one that has any
}

TEST(LineScores, CountALineAndItsCopyButNotThatOfTheNextEdge) {
  const Curve edge = polyline({{-1, 0, 0}, {1, 0, 0}});
  const Curve next = polyline({{-1, 0.012, 0}, {1, 0.012, 0}});
  EXPECT_DOUBLE_EQ(score_lines(std::vector{edge, edge}, std::vector{edge}, {}).pieces, 2.0);
  EXPECT_DOUBLE_EQ(score_lines(std::vector{edge, next}, std::vector{edge, next}, {}).pieces, 1.0);
}

TEST(LineScores, CountEndsAndBendsOncePerPlace) {
  // An L of one line against the same of two: the bend is a corner, three in all.
  const std::vector<Curve> bent = {polyline({{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}})};
  const std::vector<Curve> two = {polyline({{-1, 0, 0}, {0, 0, 0}}),
                                  polyline({{0, 0, 0}, {0, 1, 0}})};
  EXPECT_DOUBLE_EQ(score_lines(bent, two, {}).corners, 1.0);
  // 25 degrees are no corner: two of the three are found, all that are said are true.
  const double t = 25.0 / 180.0 * std::numbers::pi;
  const Vec3 end(std::cos(t), std::sin(t), 0);
  const std::vector<Curve> soft = {polyline({{-1, 0, 0}, {0, 0, 0}, end})};
  const std::vector<Curve> split = {polyline({{-1, 0, 0}, {0, 0, 0}}), polyline({{0, 0, 0}, end})};
  EXPECT_NEAR(score_lines(soft, split, {}).corners, 0.8, 1e-12);
  // A closed square has four corners, wherever it begins; a circle none.
  const std::vector<Curve> square = {polyline({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, true)};
  const std::vector<Curve> sides = {
      polyline({{0, 0, 0}, {1, 0, 0}}), polyline({{1, 0, 0}, {1, 1, 0}}),
      polyline({{1, 1, 0}, {0, 1, 0}}), polyline({{0, 1, 0}, {0, 0, 0}})};
  EXPECT_DOUBLE_EQ(score_lines(square, sides, {}).corners, 1.0);
  const std::vector<Curve> round = {circle(Vec3::Zero(), 0.5)};
  EXPECT_DOUBLE_EQ(score_lines(round, round, {}).corners, 1.0);
  EXPECT_DOUBLE_EQ(score_lines(square, round, {}).corners, 0.0);
}

TEST(LineScores, DoNotDependOnPlaceAndSize) {
  Random random(3);
  std::vector<Vec3> cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.push_back(uniform_vector(random, -Vec3::Ones(), Vec3::Ones()));
  }
  const std::vector<Curve> truth = cube_edges();
  const std::vector<Curve> found = shifted(truth, {0.012, 0.003, 0.0});
  const LineScores here = score_lines(found, truth, frame_of_cloud(cloud));
  const auto away = [](Vec3& p) { p = 40.0 * p + Vec3(652000, 6862000, 35); };
  std::vector<Curve> far_truth = truth, far_found = found;
  for (Vec3& p : cloud) away(p);
  for (auto* curves : {&far_truth, &far_found}) {
    for (Curve& curve : *curves) {
      for (Vec3& p : curve.points) away(p);
    }
  }
  const LineScores there = score_lines(far_found, far_truth, frame_of_cloud(cloud));
  EXPECT_NEAR(here.chamfer, there.chamfer, 1e-9);
  EXPECT_NEAR(here.hausdorff, there.hausdorff, 1e-9);
  EXPECT_NEAR(here.fine_precision, there.fine_precision, 1e-9);
  EXPECT_DOUBLE_EQ(here.found, there.found);
  EXPECT_DOUBLE_EQ(here.corners, there.corners);
}

TEST(LineFrame, IsTheMeanAndTheLargestCoordinate) {
  const std::vector<Vec3> cloud = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {4, 2, 0}, {NAN, 0, 0}};
  const LineFrame frame = frame_of_cloud(cloud);
  EXPECT_EQ(frame.centre, Vec3(1, 0.5, 0));
  EXPECT_DOUBLE_EQ(frame.scale, 3.0);
  const LineFrame box =
      frame_of_curves(std::vector{circle({1, 2, 3}, 0.5), polyline({{1, 2, 3}, {1, 5.5, 3}})});
  EXPECT_LT((box.centre - Vec3(1, 3.5, 3)).norm(), 1e-3);
  EXPECT_NEAR(box.scale, 2.0, 1e-3);
  EXPECT_ERROR(ErrorKind::kInsufficient, frame_of_cloud({}));
  EXPECT_ERROR(ErrorKind::kInsufficient, frame_of_cloud(std::vector<Vec3>(3, Vec3(1, 2, 3))));
  EXPECT_ERROR(ErrorKind::kInsufficient, frame_of_curves({}));
}

TEST(LineScores, RefuseCurvesOfAnotherUnit) {
  const LineFrame tiny = {Vec3::Zero(), 1e-6};
  EXPECT_ERROR(ErrorKind::kInsufficient, score_lines(cube_edges(), cube_edges(), tiny));
}

TEST(LineScores, OfNothingAreNothing) {
  const LineScores scores = score_lines({}, cube_edges(), {});
  EXPECT_TRUE(std::isnan(scores.chamfer));
  EXPECT_TRUE(std::isnan(scores.hausdorff));
  EXPECT_TRUE(std::isnan(scores.pieces));
  EXPECT_EQ(scores.precision + scores.recall + scores.found + scores.corners, 0.0);
  EXPECT_ERROR(ErrorKind::kInsufficient, score_lines(cube_edges(), {}, {}));
}

TEST(LineReport, LeavesOutWhatHasNoValue) {
  const std::vector<Curve> truth = cube_edges();
  const std::vector<NamedLineScores> clouds = {
      {"good", score_lines(truth, truth, {})},
      {"half", score_lines(std::vector<Curve>(truth.begin(), truth.begin() + 6), truth, {})},
      {"none", score_lines({}, truth, {})}};
  const auto json = nlohmann::json::parse(to_json(clouds));
  ASSERT_EQ(json["clouds"].size(), 3u);
  EXPECT_EQ(json["clouds"][0]["name"], "good");
  EXPECT_EQ(json["clouds"][1]["lines"], 6);
  EXPECT_EQ(json["clouds"][1]["true_curves"], 12);
  EXPECT_TRUE(json["clouds"][2]["pieces"].is_null());
  EXPECT_DOUBLE_EQ(json["mean"]["pieces"], 1.0);
  EXPECT_DOUBLE_EQ(json["mean"]["found"], 0.5);
  EXPECT_DOUBLE_EQ(json["median"]["found"], 0.5);
  const std::string table = to_table(clouds);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
  EXPECT_NE(table.find("none                          0     12       -"), std::string::npos)
      << table;
}

TEST(LineReport, ReplacesBytesOfNamesThatAreNotUtf8) {
  const auto json = nlohmann::json::parse(to_json(std::vector<NamedLineScores>{{"lat\xfcin", {}}}));
  EXPECT_EQ(json["clouds"][0]["name"], "lat\uFFFDin");
}

}  // namespace
}  // namespace pcednet::eval
