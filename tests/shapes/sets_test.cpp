#include "workbench/shapes/sets.h"

#include <gtest/gtest.h>

#include <set>

namespace pcednet::shapes {
namespace {

TEST(CloudSets, EveryCloudHasAFileOfItsOwn) {
  for (const CloudSet& set : cloud_sets()) {
    std::set<std::string> names;
    const auto recipes = set.recipes(1);
    for (const CloudRecipe& recipe : recipes) names.insert(recipe.name);
    EXPECT_EQ(names.size(), recipes.size()) << set.name;
    EXPECT_FALSE(recipes.empty()) << set.name;
  }
}

TEST(CloudSets, ARecipeMakesTheCloudOfItsNameAndSeed) {
  const auto recipes = default_set(2, {.extras = false});
  ASSERT_EQ(recipes.size(), 9u);
  const GeneratedCloud made = recipes.front().make();
  const GeneratedCloud expected = generate(default_recipes(2, {.extras = false}).front(), 2);
  EXPECT_EQ(made.name, recipes.front().name);
  EXPECT_EQ(made.cloud.positions, expected.cloud.positions);
  EXPECT_EQ(made.cloud.labels, expected.cloud.labels);
}

}  // namespace
}  // namespace pcednet::shapes
