#include "workbench/shapes/line_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/scan_set.h"

namespace pcednet::shapes {
namespace {

/// Points every `step` along the curves.
std::vector<Vec3> points_along(const std::vector<lines::Curve>& curves, double step) {
  std::vector<Vec3> points;
  for (const lines::Curve& curve : curves) {
    const std::vector<Vec3> vertices = lines::sampled(curve, 0.1 * step);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const Vec3 along = vertices[i] - vertices[i - 1];
      const int pieces = 1 + static_cast<int>(along.norm() / step);
      for (int k = 0; k <= pieces; ++k) points.push_back(vertices[i - 1] + k * along / pieces);
    }
  }
  return points;
}

std::vector<double> distances(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const spatial::KdTree tree(to);
  std::vector<spatial::Neighbour> near;
  std::vector<double> result;
  for (const Vec3& p : from) {
    tree.nearest(p, 1, near);
    result.push_back(std::sqrt(near.front().sq_distance));
  }
  return result;
}

std::vector<Vec3> with_label(const PointCloud& cloud, EdgeClass label) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.labels[i] == label) points.push_back(cloud.positions[i]);
  }
  return points;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

TEST(TrueCurvesOfSets, HoldTheSharpVerticesOfMeshes) {
  CadRecipe recipe = cad_recipes(3)[0];
  recipe.style.points = 2000;
  const GeneratedCloud made = generate(recipe, 3);
  const std::vector<Vec3> sharp = with_label(made.cloud, kSharpEdge);
  ASSERT_GT(sharp.size(), 50u);
  EXPECT_LT(largest(distances(sharp, points_along(made.curves, 5e-4))), 3e-4);
}

TEST(TrueCurvesOfSets, AreThoseThatTheDefaultSetIsLabelledBy) {
  const std::vector<Recipe> recipes = default_recipes(1);
  for (const std::size_t i : {0u, 3u}) {
    Recipe recipe = recipes[i];
    recipe.points = 2000;
    const GeneratedCloud made = generate(recipe, 1);
    const double spacing = std::sqrt(surface_area(recipe.shape) / 2000.0);
    const auto sharp = with_label(made.cloud, kSharpEdge);
    const auto along = points_along(made.curves, 0.02 * spacing);
    EXPECT_LT(largest(distances(sharp, along)), (recipe.bands.sharp + 0.02) * spacing);
    const auto flat = distances(with_label(made.cloud, kNonEdge), along);
    EXPECT_GT(*std::min_element(flat.begin(), flat.end()), 0.98 * recipe.bands.sharp * spacing);
  }
}

TEST(TrueCurvesOfSets, OfScansAreTheEdgesThatWereSeen) {
  ScanRecipe recipe = scan_recipes(1)[1];
  recipe.scanner.places = 1;
  recipe.scanner.rays = 6000;
  const GeneratedCloud made = generate(recipe, 1);
  ASSERT_FALSE(made.curves.empty());
  const auto sharp = distances(with_label(made.cloud, kSharpEdge), points_along(made.curves, 0.01));
  ASSERT_GT(sharp.size(), 20u);
  std::size_t near = 0;
  for (const double d : sharp) near += d < 0.6;  // half the spacing of slanted, far ground
  EXPECT_GT(near, sharp.size() * 95 / 100);
}

TEST(LineSet, HasEveryFamilyInEveryState) {
  std::set<std::string> names;
  for (const LineRecipe& recipe : line_recipes()) names.insert(recipe.name);
  EXPECT_EQ(names.size(), 134u);
  for (const char* name :
       {"plate_0", "plate_1_noisy", "dome_0_scanned", "roof_hip_1", "survey_crossing_0"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(LineSet, HasPointsOfPartsWithoutNormals) {
  using Kind = LineRecipe::Kind;
  double typical[3];
  std::vector<std::size_t> curves;
  for (const Kind kind : {Kind::kClean, Kind::kNoisy, Kind::kScanned}) {
    const LineRecipe recipe = {.name = "plate", .kind = kind, .points = 4000};
    const GeneratedCloud made = generate(recipe, 2);
    EXPECT_FALSE(made.cloud.has_normals());
    EXPECT_GT(made.cloud.size(), 3000u);
    EXPECT_LE(made.cloud.size(), 4000u);
    ASSERT_EQ(made.cloud.labels.size(), made.cloud.size());
    curves.push_back(made.curves.size());
    auto sharp = distances(with_label(made.cloud, kSharpEdge), points_along(made.curves, 1e-3));
    ASSERT_GT(sharp.size(), 100u);
    std::nth_element(sharp.begin(), sharp.begin() + sharp.size() / 2, sharp.end());
    typical[static_cast<int>(kind)] = sharp[sharp.size() / 2];
  }
  EXPECT_EQ(curves[0], curves[1]);
  EXPECT_LE(curves[2], curves[0]);
  EXPECT_GE(2 * curves[2], curves[0]);
  EXPECT_GT(typical[1], 1.3 * typical[0]);
}

TEST(LineSet, DrawsTheSameCloudTwice) {
  const LineRecipe recipe = {
      .name = "ring", .kind = LineRecipe::Kind::kScanned, .family = 8, .points = 2000};
  EXPECT_EQ(generate(recipe, 1).cloud.positions, generate(recipe, 1).cloud.positions);
  EXPECT_NE(generate(recipe, 1).cloud.positions, generate(recipe, 2).cloud.positions);
}

TEST(LineSet, HasRoofsAsPublished) {
  for (const LineRecipe& recipe : line_recipes()) {
    if (!recipe.name.starts_with("roof")) continue;
    const GeneratedCloud made = generate(recipe, 1);
    ASSERT_EQ(made.cloud.size(), 1024u) << recipe.name;
    const BoundingBox box = bounding_box(made.cloud.positions);
    EXPECT_GT(box.diagonal(), 2.0) << recipe.name;
    EXPECT_LT(box.diagonal(), 20.0) << recipe.name;
    // Every line is covered: the widest gap among 1,000 points on 100 square metres.
    EXPECT_LT(largest(distances(points_along(made.curves, 0.1), made.cloud.positions)), 1.5)
        << recipe.name;
    std::set<std::vector<double>> distinct;
    for (const Vec3& p : made.cloud.positions) distinct.insert({p.x(), p.y(), p.z()});
    EXPECT_GT(distinct.size(), 600u);
    EXPECT_LT(distinct.size(), 800u);
  }
}

TEST(LineSet, HasSurveyedRoofs) {
  std::size_t roofs = 0;
  for (const LineRecipe& recipe : line_recipes()) {
    if (recipe.kind != LineRecipe::Kind::kSurveyedRoof) continue;
    ++roofs;
    const GeneratedCloud made = generate(recipe, 1);
    ASSERT_EQ(made.cloud.size(), 1024u) << recipe.name;
    const std::vector<Vec3> corners = points_along(made.curves, 100.0);
    ASSERT_FALSE(corners.empty()) << recipe.name;
    BoundingBox box = bounding_box(corners);
    std::size_t inside = 0;
    std::set<std::vector<double>> distinct;
    for (const Vec3& p : made.cloud.positions) {
      distinct.insert({p.x(), p.y(), p.z()});
      inside += ((p - box.centre()).cwiseAbs() - 0.5 * (box.max - box.min)).maxCoeff() < 0.4;
    }
    EXPECT_GT(inside, 900u) << recipe.name;  // chimneys and walls may reach beyond the lines
    EXPECT_GT(distinct.size(), 600u) << recipe.name;
    EXPECT_LT(distinct.size(), 860u) << recipe.name;
  }
  EXPECT_EQ(roofs, 34u);
}

TEST(LineSet, HasRoofsInRowsOfPoints) {
  // Seen along the rows, a flown roof is a few dozen stacks of points; others fill every place.
  int fewest[2] = {1000, 1000};
  for (const LineRecipe& recipe : line_recipes()) {
    if (recipe.name != "roof_flat_0" && recipe.name != "roof_flat_1") continue;
    const std::vector<Vec3> positions = generate(recipe, 3).cloud.positions;
    int& least = fewest[recipe.kind == LineRecipe::Kind::kFlownRoof];
    for (double angle = 0.0; angle < std::numbers::pi; angle += 0.002) {
      std::set<int> places;
      for (const Vec3& p : positions) {
        const double across = std::cos(angle) * p.x() + std::sin(angle) * p.y();
        places.insert(static_cast<int>(std::floor(across / 0.04)));
      }
      least = std::min(least, static_cast<int>(places.size()));
    }
  }
  EXPECT_LT(fewest[1], 0.8 * fewest[0]);
}

}  // namespace
}  // namespace pcednet::shapes
