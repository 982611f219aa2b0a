#include "pcednet/lines/roofs/folded_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "pcednet/core/random_vectors.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

constexpr double kRoofLength = 10.0, kRoofWidth = 6.0;
constexpr double kUpper = 0.25, kLower = 0.45, kBreak = 1.5;  // slopes, and where they meet

/// A surface seen from above: 1,000 points, a quarter of a unit apart, uniform in plan.
struct Surface {
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;

  Surface(const std::function<double(double, double)>& height, double noise) {
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
      const double x = random.uniform(0.0, kRoofLength), y = random.uniform(0.0, kRoofWidth);
      positions.emplace_back(x, y, height(x, y) + noise * random.normal());
    }
    normals.assign(positions.size(), Vec3::UnitZ());
    classes.assign(positions.size(), kNonEdge);
  }
  EdgePoints points() const { return {positions, normals, classes}; }
  Faces faces() const {
    const OrderedPoints cloud(points());
    return find_faces(cloud, measure_sampling(cloud), nullptr);
  }
};

/// Four slopes, of 14 and 24 degrees.
double gambrel(double, double y) {
  const double inside = std::min(y, kRoofWidth - y);
  return kLower * std::min(inside, kBreak) + kUpper * std::max(0.0, inside - kBreak);
}

TEST(FoldedFaces, AreTheTwoSlopesOfAGambrelRoofInNoise) {
  for (const double noise : {0.01, 0.03}) {
    const Surface roof(gambrel, noise);
    const Faces faces = roof.faces();
    ASSERT_EQ(faces.faces.size(), 4u) << noise;
    EXPECT_GT(faces.share, 0.95);
    std::vector<double> slopes;
    for (const Face& face : faces.faces) {
      slopes.push_back(std::abs(face.normal.y() / face.normal.z()));
    }
    std::sort(slopes.begin(), slopes.end());
    for (const int k : {0, 1}) EXPECT_NEAR(slopes[static_cast<std::size_t>(k)], kUpper, 0.03);
    for (const int k : {2, 3}) EXPECT_NEAR(slopes[static_cast<std::size_t>(k)], kLower, 0.03);
    const auto curves = find_lines(roof.points(), {.boundaries = true});
    EXPECT_EQ(std::count_if(curves.begin(), curves.end(),
                            [](const Curve& curve) { return curve.edge_class != kBoundary; }),
              3);
  }
}

TEST(FoldedFaces, AreNotPlanesOrVaults) {
  const auto shed = [](double, double y) { return 0.4 * y; };
  EXPECT_EQ(Surface(shed, 0.03).faces().faces.size(), 1u);
  // As high as the gambrel roof, and as steep at its eaves.
  const auto vault = [](double, double y) { return 0.5 * y * (1.0 - y / kRoofWidth); };
  EXPECT_LT(Surface(vault, 0.005).faces().share, 0.9);
}

TEST(FoldedFaces, MayHaveTwoFolds) {
  const auto bay = [](double x, double) { return 0.12 * std::max(0.0, std::abs(x - 5.0) - 2.0); };
  const Faces faces = Surface(bay, 0.03).faces();
  EXPECT_EQ(faces.faces.size(), 3u);
  EXPECT_GT(faces.share, 0.95);
}

}  // namespace
}  // namespace pcednet::lines
