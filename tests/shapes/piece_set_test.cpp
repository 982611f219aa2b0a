#include "workbench/shapes/piece_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>
#include <variant>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/parallel.h"
#include "workbench/shapes/varied_set.h"

namespace pcednet::shapes {
namespace {

/// Those pieces of terrains that are made soonest.
std::vector<PieceRecipe> some_pieces() {
  std::vector<PieceRecipe> recipes = piece_recipes(3);
  std::erase_if(recipes, [](const PieceRecipe& recipe) {
    const auto* terrain = std::get_if<TerrainRecipe>(&recipe.whole);
    return recipe.points == 0 || !terrain || terrain->points > 15000;
  });
  recipes.resize(std::min<std::size_t>(recipes.size(), 6));
  return recipes;
}

double distance(const Vec3& a, const Vec3& b, PieceRecipe::Cut cut) {
  const Vec3 offset = (a - b).cwiseAbs();
  if (cut == PieceRecipe::Cut::kBall) return offset.norm();
  return cut == PieceRecipe::Cut::kCube ? offset.maxCoeff() : std::max(offset.x(), offset.y());
}

TEST(Pieces, AreWholesOfTheSparseSetAndPiecesOfScans) {
  const auto recipes = piece_recipes(3);
  std::set<std::string> names;
  std::size_t wholes = 0;
  for (const PieceRecipe& recipe : recipes) {
    names.insert(recipe.name);
    if (recipe.points == 0) ++wholes;
    if (recipe.points == 0) continue;
    EXPECT_GE(recipe.points, 600u);
    EXPECT_LE(recipe.points, 4000u);
  }
  EXPECT_EQ(names.size(), recipes.size());
  EXPECT_EQ(wholes, 2 * (sparse_part_recipes(3).size() + sparse_shape_recipes(3).size() +
                         sparse_roof_recipes(3).size()));
  EXPECT_GT(recipes.size(), wholes + 300);
}

TEST(Pieces, HaveAClassOfTheirOwnAndNoNormals) {
  std::vector<PieceRecipe> recipes = some_pieces();
  recipes.push_back(piece_recipes(3).front());
  for (const PieceRecipe& recipe : recipes) {
    const PointCloud cloud = generate(recipe, 3).cloud;
    EXPECT_EQ(names_of(classes_of(cloud.comments)), "whole, piece");
    EXPECT_TRUE(cloud.normals.empty());
    const auto wanted = static_cast<std::uint8_t>(recipe.points > 0 ? 1 : 0);
    EXPECT_EQ(cloud.labels, std::vector<std::uint8_t>(cloud.size(), wanted));
  }
}

TEST(Pieces, HoldWhatIsNearestToOneOfTheirPoints) {
  for (const PieceRecipe& recipe : some_pieces()) {
    const auto all =
        generate(std::get<TerrainRecipe>(recipe.whole), recipe.whole_seed).cloud.positions;
    const auto piece = generate(recipe, 3).cloud.positions;
    ASSERT_EQ(piece.size(), recipe.points);
    const auto key = [](const Vec3& p) { return std::tuple(p.x(), p.y(), p.z()); };
    std::set<std::tuple<double, double, double>> inside;
    for (const Vec3& p : piece) inside.insert(key(p));
    // One of its points has all of them nearer than any other.
    EXPECT_TRUE(std::any_of(piece.begin(), piece.end(), [&](const Vec3& centre) {
      double reach = 0.0, beyond = std::numeric_limits<double>::infinity();
      for (const Vec3& p : piece) reach = std::max(reach, distance(p, centre, recipe.cut));
      for (const Vec3& p : all) {
        if (inside.count(key(p)) == 0) beyond = std::min(beyond, distance(p, centre, recipe.cut));
      }
      return reach <= beyond;
    })) << recipe.name;
  }
}

TEST(Pieces, AreTheSameForAnyNumberOfThreads) {
  const PieceRecipe recipe = some_pieces().front();
  set_thread_count(1);
  const auto one = generate(recipe, 3).cloud.positions;
  set_thread_count(8);
  const auto eight = generate(recipe, 3).cloud.positions;
  set_thread_count(0);
  EXPECT_EQ(one, eight);
  EXPECT_NE(generate(recipe, 4).cloud.positions, one);  // another place of the same terrain
}

}  // namespace
}  // namespace pcednet::shapes
