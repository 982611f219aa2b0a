#include "workbench/shapes/solids/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pcednet/core/random.h"
#include "workbench/shapes/solids/cad_parts.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/solids/solid_samples.h"

namespace pcednet::shapes {
namespace {

TEST(Profile, KnowsDistancesToARoundedSquare) {
  const Profile square = rectangle(1.0, 1.0, Corner::Shape::kFillet, 0.5);
  std::size_t side = 0;
  EXPECT_NEAR(square.distance({0, 0}, side), -1.0, 1e-12);
  EXPECT_NEAR(square.distance({2, 0.2}, side), 1.0, 1e-12);
  // The corner's arc is about (0.5, 0.5).
  EXPECT_NEAR(square.distance({2, 2}, side), 1.5 * std::sqrt(2.0) - 0.5, 1e-12);
  EXPECT_TRUE(square.is_round(side));
  EXPECT_NEAR(square.distance({0.99, 0.99}, side), 0.49 * std::sqrt(2.0) - 0.5, 1e-12);
}

TEST(Profile, CutsCornersThatHaveNoRoomSmaller) {
  const Profile square = rectangle(1.0, 1.0, Corner::Shape::kChamfer, 50.0);
  std::size_t side = 0;
  EXPECT_LT(square.distance({0, 0}, side), 0.0);
  EXPECT_GT(square.distance({0.95, 0.95}, side), 0.0);
}

TEST(Profile, TellsInsideFromOutsideOfAConcaveFillet) {
  using S = Corner::Shape;
  const Profile corner =
      outline({{{0, 0}}, {{2, 0}}, {{2, 1}}, {{1, 1}, S::kFillet, 0.4}, {{1, 2}}, {{0, 2}}});
  std::size_t side = 0;
  EXPECT_LT(corner.distance({1.05, 1.05}, side), 0.0);  // filled by the fillet
  EXPECT_GT(corner.distance({1.2, 1.2}, side), 0.0);
  EXPECT_NEAR(corner.distance({1.05, 1.05}, side), 0.4 - std::hypot(0.35, 0.35), 1e-12);
}

TEST(Profile, OfAWheelLooksTheSameFromEveryTooth) {
  constexpr int kTeeth = 24;
  const auto turn = [](int teeth) {
    return Eigen::Rotation2Dd(2.0 * std::numbers::pi * teeth / kTeeth).toRotationMatrix();
  };
  std::vector<Corner> corners;
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    corners.push_back({turn(tooth) * Vec2(1.0, 0.0), Corner::Shape::kFillet, 0.02});
    corners.push_back({turn(tooth) * Vec2(0.8, 0.1), Corner::Shape::kSharp});
  }
  const Profile wheel = outline(corners);
  const std::size_t sides = wheel.size() / kTeeth;
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double y = random.uniform(-1.5, 1.5), x = random.uniform(-1.5, 1.5);
    const Vec2 p(x, y);
    std::size_t nearest = 0, turned = 0;
    const double distance = wheel.distance(p, nearest);
    for (int tooth = 1; tooth < kTeeth; ++tooth) {
      EXPECT_NEAR(wheel.distance(turn(tooth) * p, turned), distance, 1e-12);
      const std::size_t shift = sides * static_cast<std::size_t>(tooth);
      EXPECT_EQ(turned, (nearest + shift) % wheel.size());
    }
  }
}

TEST(Solid, AddsAndCutsInOrder) {
  Solid part;
  part.add(box(1, 1, 1, Vec3::Zero()));
  part.cut(cylinder(0.5, 2, at(Vec3::Zero())));
  EXPECT_GT(part.value(Vec3::Zero()).distance, 0.0);
  EXPECT_NEAR(part.value(Vec3(0.75, 0, 0)).distance, -0.25, 1e-12);
  part.add(cylinder(0.2, 0.5, at(Vec3::Zero())));
  EXPECT_LT(part.value(Vec3::Zero()).distance, 0.0);
}

TEST(Solid, HasNormalsOutOfIt) {
  Solid part;
  part.add(box(1, 1, 1, Vec3::Zero()));
  part.cut(cylinder(0.5, 2, at(Vec3::Zero())));
  const Vec3 on_hole(0.5, 0, 0.1);
  const Face face = part.value(on_hole).face;
  EXPECT_TRUE(part.is_curved(face));
  EXPECT_NEAR((part.normal_of(face, on_hole) - Vec3(-1, 0, 0)).norm(), 0.0, 1e-6);
}

TEST(SolidSamples, LieOnTheSurfaceByArea) {
  Solid part;
  part.add(turned(circle_profile({0, 0}, 0.5), at(Vec3(3, 0, 0))));
  const SolidSamples samples = sample_solid(part, 20000, 1);
  // The area of a sphere of radius 1/2, from counts: 1 % is three standard deviations.
  EXPECT_NEAR(samples.area, std::numbers::pi, 0.03 * std::numbers::pi);
  int upper = 0;
  for (const FacePoint& point : samples.points) {
    const Vec3 out = point.position - Vec3(3, 0, 0);
    EXPECT_NEAR(out.norm(), 0.5, 1e-8);
    EXPECT_NEAR(point.normal.dot(out), 0.5, 1e-6);
    if (out.z() > 0.25) ++upper;  // a quarter of the area, by Archimedes
  }
  EXPECT_NEAR(upper, 5000, 200);
}

TEST(SolidSamples, FindBordersExactly) {
  Solid part;
  part.add(box(0.5, 0.5, 0.25, Vec3::Zero()));
  part.cut(cylinder(0.2, 1, along(0, Vec3(0, 0, 0.25))));  // a groove along x in the top
  const SolidSamples samples = sample_solid(part, 20000, 2);
  std::size_t groove = 0, rims = 0;
  for (const BorderPoint& border : find_borders(part, samples)) {
    if (border.turn() < 0.01) continue;  // between the quarters of the groove
    const Vec3& p = border.position;
    const auto near = [](double a, double b) { return std::abs(std::abs(a) - b) < 1e-6; };
    const bool side_x = near(p.x(), 0.5), side_y = near(p.y(), 0.5), cap = near(p.z(), 0.25);
    const bool in_groove = near(std::hypot(p.y(), p.z() - 0.25), 0.2);
    EXPECT_GE(side_x + side_y + cap + in_groove, 2) << p.transpose();
    EXPECT_NEAR(border.turn(), 0.5 * std::numbers::pi, 1e-4);
    (in_groove ? groove : rims) += 1;
  }
  EXPECT_GT(groove, 200u);
  EXPECT_GT(rims, 500u);
}

TEST(SolidSamples, FindWhereFacesJoinSmoothly) {
  Solid part;
  part.add(prism(rectangle(0.5, 0.5, Corner::Shape::kFillet, 0.2), 0.25, at(Vec3::Zero())));
  std::size_t smooth = 0;
  for (const BorderPoint& border : find_borders(part, sample_solid(part, 20000, 3))) {
    if (border.turn() > 0.01) continue;
    ++smooth;
    const double x = std::abs(border.position.x()), y = std::abs(border.position.y());
    EXPECT_NEAR(std::min(x, y), 0.3, 2e-3);  // where the side ends and the fillet begins
  }
  EXPECT_GT(smooth, 50u);
}

TEST(CadParts, OfEveryFamilyHaveASurfaceAndDiffer) {
  for (int family = 0; family < kPartFamilies; ++family) {
    Random one(5, 1), two(5, 2);
    const Solid a = random_part(family, one), b = random_part(family, two);
    EXPECT_GT(sample_solid(a, 500, 1).area, 0.01) << part_family_name(family);
    EXPECT_NE(a.box().max, b.box().max) << part_family_name(family);
  }
}

}  // namespace
}  // namespace pcednet::shapes
