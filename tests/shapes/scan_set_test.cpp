#include "workbench/shapes/scan_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "pcednet/core/parallel.h"
#include "workbench/shapes/solids/part_pieces.h"

namespace pcednet::shapes {
namespace {

/// A wall of 4 x 4 at y = 2, before it a post.
Scene post_before_wall() {
  Scene scene;
  scene.solid.add(box(2, 0.1, 2, Vec3(0, 2.1, 0)));
  scene.solid.add(box(0.2, 0.2, 2, Vec3(0, 0, 0)));
  scene.scanners = {{Vec3(0, -4, 0), Vec3(0, 0, 0)}};
  return scene;
}

TEST(Scanner, SeesSurfacesAndTheirShadows) {
  const Scan scan = scan_scene(post_before_wall(),
                               {.rays = 20000, .range_noise = 0, .mixed = 0, .outliers = 0}, 1);
  std::size_t wall = 0, post = 0;
  for (const Vec3& p : scan.positions) {
    if (std::abs(p.y() - 2.0) < 2e-3) {
      ++wall;
      EXPECT_GT(std::abs(p.x()), 0.2 * 6.0 / 4.2 - 1e-2);  // the post's shadow
    } else {
      EXPECT_NEAR(p.y(), -0.2, 2e-3);
      ++post;
    }
  }
  EXPECT_GT(wall, 500u);
  EXPECT_GT(post, 100u);
}

TEST(Scanner, SeesTheWallEndAtTheShadowAndAtItsSides) {
  const Scan scan = scan_scene(post_before_wall(),
                               {.rays = 20000, .range_noise = 0, .mixed = 0, .outliers = 0}, 1);
  constexpr double kRays = 6.0 * 100.0 / 129.0 * std::numbers::pi / 180.0;  // apart, at y = 2
  const double shadow = 0.2 * 6.0 / 4.2;
  std::size_t ends = 0;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3& p = scan.positions[i];
    if (std::abs(p.y() - 2.0) > 2e-3 || std::abs(p.z()) > 1.5) continue;
    const double x = std::abs(p.x()), beside_shadow = x - shadow, inside = 2.0 - x;
    const bool open = !scan.open_sides[i].isZero(0.0);
    ends += open;
    EXPECT_EQ(open, std::min(beside_shadow, inside) < 1.05 * kRays) << p.transpose();
    const double away = scan.open_sides[i].x() * p.x();  // from the shadow
    if (open) {
      EXPECT_GT(beside_shadow < 0.5 ? -away : away, 0.0);
    }
  }
  EXPECT_GT(ends, 60u);
}

TEST(ScanSet, LabelsTheEndsThatNoOtherScanSeesBeyond) {
  const auto shares = [](std::size_t places) {
    const PointCloud cloud =
        generate({.name = "yard", .kind = 1, .scanner = {.rays = 9000, .places = places}}, 1).cloud;
    const auto ends = std::count(cloud.labels.begin(), cloud.labels.end(), kBoundary);
    return static_cast<double>(ends) / static_cast<double>(cloud.size());
  };
  EXPECT_GT(shares(1), 0.03);
  EXPECT_LT(shares(1), 0.15);
  EXPECT_LT(shares(3), 0.8 * shares(1));
}

TEST(Scanner, MakesItsFaultsAsOften) {
  const Scene scene = post_before_wall();
  const auto count = [&](const ScannerOptions& options, ReturnKind kind) {
    const Scan scan = scan_scene(scene, options, 2);
    return std::count(scan.kinds.begin(), scan.kinds.end(), kind);
  };
  const ScannerOptions clean = {.rays = 20000, .mixed = 0, .outliers = 0};
  EXPECT_EQ(count(clean, ReturnKind::kStray), 0);
  EXPECT_GT(count({.rays = 20000, .mixed = 1, .outliers = 0}, ReturnKind::kStray), 20);
  const auto outliers = count({.rays = 20000, .mixed = 0, .outliers = 0.1}, ReturnKind::kStray);
  const auto all = count(clean, ReturnKind::kSolid);
  EXPECT_NEAR(static_cast<double>(outliers), 0.1 * static_cast<double>(all),
              0.03 * static_cast<double>(all));
  Scene leafy = scene;
  leafy.foliage = {Vec3(0.0, -2.0, 0.0), Vec3(0.3, -2.0, 0.2)};
  const Scan scan = scan_scene(leafy, clean, 2);
  EXPECT_GT(std::count(scan.kinds.begin(), scan.kinds.end(), ReturnKind::kLeaf), 2);
}

TEST(ScanSet, LabelsBandsAlongTrueEdges) {
  const ScanRecipe recipe = {.name = "room", .kind = 2, .scanner = {.rays = 8000}};
  const PointCloud cloud = generate(recipe, 1).cloud;
  std::size_t counts[5] = {};
  for (const std::uint8_t label : cloud.labels) ++counts[label == kUnlabelled ? 4 : label];
  const auto share = [&](int i) {
    return static_cast<double>(counts[i]) / static_cast<double>(cloud.size());
  };
  EXPECT_GT(share(0), 0.6);
  EXPECT_GT(share(1), 0.02);
  EXPECT_GT(share(2), 0.01);
  EXPECT_GT(share(1), share(2));
  for (const Vec3& n : cloud.normals) EXPECT_NEAR(n.norm(), 1.0, 1e-6);
}

TEST(ScanSet, GivesTheSameCloudForAnyNumberOfThreads) {
  for (int kind = 0; kind < kSceneKinds; ++kind) {
    const ScanRecipe recipe = {.name = "a", .kind = kind, .scanner = {.rays = 1500, .places = 2}};
    set_thread_count(1);
    const GeneratedCloud one = generate(recipe, 7);
    set_thread_count(8);
    const GeneratedCloud eight = generate(recipe, 7);
    set_thread_count(0);
    ASSERT_GT(one.cloud.size(), 200u) << scene_kind_name(kind);
    EXPECT_EQ(one.cloud.positions, eight.cloud.positions);
    EXPECT_EQ(one.cloud.labels, eight.cloud.labels);
    EXPECT_NE(generate(recipe, 8).cloud.positions, one.cloud.positions);
  }
}

TEST(ScanSet, HasNamesOfItsOwn) {
  std::set<std::string> names;
  const auto recipes = scan_recipes(1);
  for (const ScanRecipe& recipe : recipes) names.insert(recipe.name);
  EXPECT_EQ(names.size(), recipes.size());
}

}  // namespace
}  // namespace pcednet::shapes
