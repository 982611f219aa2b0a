#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/surfaces/patches.h"
#include "workbench/shapes/surfaces/polyhedra.h"
#include "workbench/shapes/surfaces/sampling.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {
namespace {

const std::vector<GeneratedCloud>& paper_set() {
  static const std::vector<GeneratedCloud> clouds = [] {
    std::vector<GeneratedCloud> made;
    for (const Recipe& recipe : default_recipes(1, {.extras = false})) {
      made.push_back(generate(recipe, 1));
    }
    return made;
  }();
  return clouds;
}

double share(const PointCloud& cloud, EdgeClass label) {
  const auto count = std::count(cloud.labels.begin(), cloud.labels.end(), label);
  return 100.0 * static_cast<double>(count) / static_cast<double>(cloud.size());
}

/// The table of the paper: points, % sharp, % smooth.
TEST(DefaultSet, HasThePointCountsAndClassSharesOfThePaper) {
  struct Row {
    std::size_t points;
    double sharp;
    double smooth;
  };
  const std::map<std::string, Row> table = {
      {"cube", {1500, 12.2, 21.8}},    {"icosahedron", {600, 34.6, 46.7}},
      {"cone", {7700, 6.1, 11.7}},     {"dodecahedron", {12000, 3.5, 7.7}},
      {"fandisk", {106500, 5.5, 5.0}}, {"fourcube", {43900, 6.8, 6.6}},
  };
  std::size_t total = 0;
  for (const GeneratedCloud& generated : paper_set()) {
    const Row& row = table.at(generated.name.substr(0, generated.name.find('_')));
    const PointCloud& cloud = generated.cloud;
    EXPECT_EQ(cloud.size(), row.points) << generated.name;
    // Four binomial deviations, and 0.6 per cent plus a tenth of the share: the bands match the
    // shares only roughly, and displaced points leave them.
    const auto tolerance = [&](double percent) {
      const double p = 0.01 * percent;
      return 0.6 + 0.1 * percent + 400.0 * std::sqrt(p * (1.0 - p) / cloud.size());
    };
    EXPECT_NEAR(share(cloud, kSharpEdge), row.sharp, tolerance(row.sharp)) << generated.name;
    EXPECT_NEAR(share(cloud, kSmoothEdge), row.smooth, tolerance(row.smooth)) << generated.name;
    total += cloud.size();
  }
  EXPECT_EQ(total, 287900u);
}

TEST(DefaultSet, IsTheSameForTheSameSeedOnly) {
  const auto same = [](const GeneratedCloud& a, const GeneratedCloud& b) {
    return a.name == b.name && a.cloud.positions == b.cloud.positions &&
           a.cloud.normals == b.cloud.normals && a.cloud.labels == b.cloud.labels;
  };
  for (const std::size_t i : {0u, 1u, 3u, 9u, 11u, 16u, 21u, 30u}) {
    const Recipe one = default_recipes(1)[i];
    EXPECT_TRUE(same(generate(one, 1), generate(default_recipes(1)[i], 1))) << one.name;
    EXPECT_FALSE(same(generate(one, 1), generate(default_recipes(2)[i], 2))) << one.name;
  }
}

/// Training takes boundary for non-edge: labels of rims must not change any other.
TEST(DefaultSet, LabelsRimsInPlaceOfNonEdgeAlone) {
  for (const Recipe& recipe : default_recipes(1)) {
    const bool open = !recipe.shape.rims.empty();
    EXPECT_EQ(open, recipe.name.starts_with("x_sheets") || recipe.name.starts_with("x_wedges") ||
                        recipe.name.starts_with("x_fading") || recipe.name.starts_with("x_wall"))
        << recipe.name;
    if (!open || !recipe.name.ends_with("_0")) continue;
    Recipe without = recipe;
    without.shape.rims.clear();
    PointCloud cloud = generate(recipe, 1).cloud;
    EXPECT_GT(share(cloud, kBoundary), 0.5) << recipe.name;
    EXPECT_LT(share(cloud, kBoundary), 10.0) << recipe.name;
    std::replace(cloud.labels.begin(), cloud.labels.end(), kBoundary, kNonEdge);
    EXPECT_TRUE(cloud.labels == generate(without, 1).cloud.labels) << recipe.name;
  }
}

TEST(DefaultSet, LabelsRimsByTheirDistance) {
  Recipe recipe;
  recipe.name = "square";
  recipe.points = 2000;
  recipe.shape.patches = {parallelogram(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY())};
  add_rims(recipe.shape);
  EXPECT_EQ(recipe.shape.rims.size(), 384u);
  const double share_of_band = 100.0 * 4.0 * kBoundaryBand / std::sqrt(2000.0);
  EXPECT_NEAR(share(generate(recipe, 1).cloud, kBoundary), share_of_band, 1.2);
  recipe.shape.edges = {{Segment{Vec3::Zero(), Vec3::UnitX()}}};
  recipe.shape.rims.clear();
  add_rims(recipe.shape);
  EXPECT_EQ(recipe.shape.rims.size(), 288u);
}

TEST(DefaultSet, CloudsAreWhole) {
  for (const Recipe& recipe : default_recipes(4)) {
    const GeneratedCloud generated = generate(recipe, 4);
    const PointCloud& cloud = generated.cloud;
    EXPECT_NO_THROW(check_consistent(cloud));
    EXPECT_EQ(cloud.labels.size(), cloud.size());
    EXPECT_EQ(cloud.normals.size(), cloud.size());
    const Defects defects = find_defects(cloud);
    EXPECT_EQ(defects.positions, 0u) << generated.name;
    EXPECT_EQ(defects.normals, 0u) << generated.name;
    for (const Vec3& normal : cloud.normals) ASSERT_NEAR(normal.norm(), 1.0, 1e-9);
    EXPECT_FALSE(cloud.comments.empty());
  }
}

/// On the cube about the origin, whatever its rotation: the nearest faces are at distance
/// 1/sqrt(3).
TEST(DefaultSet, NormalsPointOutwardsUnlessAskedFor) {
  for (const bool inward : {false, true}) {
    for (const NormalSource source :
         {NormalSource::kSurface, NormalSource::kPlane10, NormalSource::kEstimated}) {
      const GeneratedCloud generated = generate(
          {.name = "c", .shape = make_shape(cube()), .normals = source, .inward = inward}, 1);
      std::size_t right = 0;
      for (std::size_t i = 0; i < generated.cloud.size(); ++i) {
        const double out = generated.cloud.positions[i].dot(generated.cloud.normals[i]);
        right += inward ? out < 0.0 : out > 0.0;
      }
      EXPECT_GE(right, generated.cloud.size() - 5);
    }
  }
}

/// Face distance 1/sqrt(3) from the centre: two coordinates there are an edge.
TEST(DefaultSet, LabelsAreTheDistanceToTheEdgesOfTheCube) {
  const Shape shape = make_shape(cube());
  Random random(3);
  const double side = 1.0 / std::sqrt(3.0);
  std::vector<Vec3> positions;
  std::vector<std::uint8_t> expected;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = uniform_vector(random, Vec3::Constant(-0.7), Vec3::Constant(0.7));
    positions.push_back(p);
    // Distance to the twelve edges, one family of four per axis.
    double nearest = 10.0;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 away;
      for (int k = 0; k < 3; ++k) away[k] = std::abs(p[k]) - side;
      away[axis] = std::max(0.0, away[axis]);
      nearest = std::min(nearest, away.norm());
    }
    expected.push_back(nearest < 0.05 ? kSharpEdge : nearest < 0.2 ? kSmoothEdge : kNonEdge);
  }
  EXPECT_EQ(label_by_distance(positions, shape.edges, {.sharp = 0.05, .smooth = 0.2}), expected);
}

TEST(DefaultSet, BandsCanBeSetForAllClouds) {
  for (const Recipe& recipe : default_recipes(1, {.bands = EdgeBands{0.4, 1.5}})) {
    EXPECT_EQ(recipe.bands.sharp, 0.4);
    EXPECT_EQ(recipe.bands.smooth, 1.5);
  }
}

TEST(Acquisition, DisplacesEveryTenthPointAlongTheDiagonal) {
  std::vector<Vec3> positions(1000, Vec3::Zero());
  Random random(1);
  const auto moved = displace_every_tenth(positions, 0.5, random);
  EXPECT_EQ(moved.size(), 100u);
  double largest = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& p = positions[i];
    EXPECT_EQ(p.x(), p.y());
    EXPECT_EQ(p.x(), p.z());
    EXPECT_EQ(p.x() != 0.0, i % 10 == 0);
    largest = std::max(largest, p.x());
  }
  EXPECT_LT(largest, 0.5);
  EXPECT_GT(largest, 0.45);
}

TEST(Acquisition, NoiseHasTheDeviationAskedFor) {
  std::vector<Vec3> positions(30000, Vec3::Zero());
  Random random(2);
  add_noise(positions, 0.1, random);
  Vec3 squares = Vec3::Zero();
  for (const Vec3& p : positions) squares += p.cwiseAbs2();
  // Four standard errors of a variance from 30,000 deviates are 3.3 %.
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(squares[axis] / 30000.0, 0.01, 0.00033);
}

TEST(Acquisition, PlaneNormalsOfAPlaneAreExact) {
  Random random(3);
  const Vec3 normal = Vec3(1.0, 2.0, -0.5).normalized();
  const Vec3 x = normal.unitOrthogonal();
  const Vec3 y = normal.cross(x);
  std::vector<Vec3> positions;
  for (int i = 0; i < 500; ++i) positions.push_back(random.uniform() * x + random.uniform() * y);
  for (const Vec3& n : plane_normals(positions)) {
    // Noise of 1e-16 over neighbourhoods of 0.05.
    EXPECT_NEAR(std::abs(n.dot(normal)), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace pcednet::shapes
