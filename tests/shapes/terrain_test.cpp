#include "workbench/shapes/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "pcednet/core/parallel.h"

namespace pcednet::shapes {
namespace {

std::ptrdiff_t count(const GeneratedCloud& generated, EdgeClass label) {
  return std::count(generated.cloud.labels.begin(), generated.cloud.labels.end(), label);
}

TEST(Terrain, HasEdgesOnHousesAlone) {
  for (TerrainRecipe recipe : terrain_recipes(3)) {
    if (recipe.points > 15000) continue;
    recipe.houses = 0;
    const GeneratedCloud wild = generate(recipe, 3);
    EXPECT_EQ(count(wild, kNonEdge), static_cast<std::ptrdiff_t>(wild.cloud.size())) << recipe.name;
    recipe.houses = 5;
    EXPECT_GT(count(generate(recipe, 3), kSharpEdge), 0) << recipe.name;
  }
}

TEST(Terrain, HasTheWantedPointsWithNormals) {
  std::set<std::string> names;
  for (const TerrainRecipe& recipe : terrain_recipes(3)) {
    names.insert(recipe.name);
    if (recipe.points > 15000) continue;
    const PointCloud cloud = generate(recipe, 3).cloud;
    EXPECT_EQ(cloud.normals.size(), cloud.size());
    const double points = static_cast<double>(cloud.size());
    EXPECT_NEAR(points / static_cast<double>(recipe.points), 1.0, 0.35) << recipe.name;
  }
  EXPECT_EQ(names.size(), terrain_recipes(3).size());
}

TEST(Terrain, IsTheSameForAnyNumberOfThreads) {
  const TerrainRecipe recipe = terrain_recipes(3).front();
  set_thread_count(1);
  const PointCloud one = generate(recipe, 3).cloud;
  set_thread_count(8);
  const PointCloud eight = generate(recipe, 3).cloud;
  set_thread_count(0);
  EXPECT_EQ(one.positions, eight.positions);
  EXPECT_EQ(one.normals, eight.normals);
  EXPECT_EQ(one.labels, eight.labels);
  EXPECT_NE(generate(recipe, 4).cloud.positions, one.positions);
}

}  // namespace
}  // namespace pcednet::shapes
