#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/scratch.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/describe.h"
#include "pcednet/detect/piece.h"
#include "pcednet/formats/write_cloud.h"
#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/line_set.h"
#include "workbench/shapes/piece_set.h"
#include "workbench/shapes/terrain.h"
#include "workbench/shapes/varied_set.h"

// The scores of the shipped models on clouds of a seed that nothing was learnt from (they learn
// from others): the smallest of `pcednet generate default|cad|worn DIR --seed 5`, scored by
// `pcednet evaluate DIR --model ... --json -`. MCC, median over the clouds and pooled:
//
//           seed 5       seed 6       seed 7       seed 5, by the wrong model
//   scan    .929 .930    .929 .931    .936 .934    .578 .543
//   cad     .861 .763    .840 .766    .728 .694    .738 .707
//   noise   .709 .750    .772 .759    .685 .723    .566 .631
//   worn    .683 .678    .608 .570    .650 .639    .368 .353
//
// So few parts differ more from seed to seed than good models from bad ones. That is why the floors
// hold for the clouds of seed 5 alone: they are three times the standard deviation over training
// seeds (docs/accuracy.md: .0025 of `scan`, .0056 of `cad`, .011 with noise, .0064 of `worn`) below
// its column. Who trains the models anew may have to measure them again. The models of the table
// were trained before today's, which score .928 .928, .829 .765, .706 .743 and .666 .673 on seed 5.
//
// `general` scores .917 .912 on default (edges), .830 .776 on cad, .532 .565 on worn, .476 .452 on
// varied, .596 .531 on sparse, and .711 .684 on noisy parts without normals (edges). Its floors are
// .018 below: three times the standard deviation over training seeds of its most variable set.
// Pooled it scored .484 on varied and .567 on sparse before it told pieces of scans from wholes:
// of clouds this small, it takes some grilles of a few hundred points for pieces. Trained again, it
// scores .570 in the median of sparse, and more than before on 408 clouds of another seed.

namespace pcednet::shapes {
namespace {

constexpr std::uint64_t kHeldOutSeed = 5;

struct Mcc {
  double median, pooled;
};

std::size_t points_of(const Recipe& recipe) {
  return recipe.points;
}
std::size_t points_of(const CadRecipe& recipe) {
  return recipe.style.points;
}
std::size_t points_of(const LineRecipe& recipe) {
  return recipe.points;
}

/// A folder with the `count` clouds of the fewest points.
class Clouds {
 public:
  template <typename Recipe>
  Clouds(std::vector<Recipe> recipes, std::size_t count) {
    std::stable_sort(recipes.begin(), recipes.end(),
                     [](const Recipe& a, const Recipe& b) { return points_of(a) < points_of(b); });
    EXPECT_GE(recipes.size(), count);
    parallel_blocks(std::min(count, recipes.size()), 1, [&](std::size_t i, std::size_t) {
      formats::write_cloud(scratch_.path(recipes[i].name + ".ply"),
                           generate(recipes[i], kHeldOutSeed).cloud);
    });
  }

  /// What `pcednet evaluate` finds.
  Mcc score(const std::string& model) const {
    const std::string command = std::string(PCEDNET_BINARY) + " evaluate " +
                                scratch_.path("").string() + " --json - --progress none --model " +
                                model;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::string text;
    std::array<char, 4096> part;
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe.get())) {
      text.append(part.data(), size);
    }
    const auto report = nlohmann::json::parse(text);
    return {report["median"]["mcc"], report["pooled"]["mcc"]};
  }

 private:
  io::Scratch scratch_;
};

struct Floor {
  std::string model;
  Mcc mcc;
};

/// The models score above their floors, and these are above what another model scores.
void expect_above(const std::vector<Floor>& floors, const Clouds& clouds,
                  const std::string& other) {
  const Mcc poor = clouds.score(other);
  for (const auto& [model, floor] : floors) {
    const Mcc found = clouds.score(model);
    EXPECT_GE(found.median, floor.median) << model;
    EXPECT_GE(found.pooled, floor.pooled) << model;
    EXPECT_LT(poor.median, floor.median) << model;
    EXPECT_LT(poor.pooled, floor.pooled) << model;
  }
}

std::vector<CadRecipe> parts(bool with_noise) {
  std::vector<CadRecipe> recipes = cad_recipes(kHeldOutSeed);
  std::erase_if(recipes, [&](const CadRecipe& r) { return (r.noise > 0.0) != with_noise; });
  return recipes;
}

TEST(ShippedModels, FindEdgesOfTheDefaultSet) {
  expect_above({{"general --positive edge", {.899, .894}}, {"scan --positive edge", {.921, .922}}},
               Clouds(default_recipes(kHeldOutSeed), 28), "worn --positive edge");
}

TEST(ShippedModels, FindEdgesOfParts) {
  expect_above({{"general", {.812, .758}}, {"cad", {.806, .746}}}, Clouds(parts(false), 24),
               "worn");
}

TEST(ShippedModels, FindEdgesOfNoisyParts) {
  expect_above({{"cad", {.676, .717}}}, Clouds(parts(true), 9), "worn");
}

TEST(ShippedModels, FindEdgesOfNoisyPartsWithoutNormals) {
  std::vector<LineRecipe> recipes = line_recipes();
  std::erase_if(recipes, [](const LineRecipe& r) { return r.kind != LineRecipe::Kind::kNoisy; });
  expect_above({{"general --positive edge", {.693, .666}}}, Clouds(std::move(recipes), 12),
               "worn --positive edge");
}

TEST(ShippedModels, FindRoundedRidgesOfWornThings) {
  expect_above({{"general", {.514, .547}}, {"worn", {.663, .658}}},
               Clouds(worn_recipes(kHeldOutSeed), 18), "cad");
}

TEST(ShippedModels, FindEdgesOfVariedParts) {
  expect_above({{"general", {.458, .434}}}, Clouds(varied_part_recipes(kHeldOutSeed), 24), "scan");
}

TEST(ShippedModels, FindEdgesOfSparseParts) {
  expect_above({{"general", {.552, .513}}}, Clouds(sparse_part_recipes(kHeldOutSeed), 48), "worn");
}

/// The share of the clouds of recipes that `general` takes for pieces of larger ones.
double share_of_pieces(const std::vector<PieceRecipe>& recipes) {
  const auto model = detect::load_model(PCEDNET_SOURCE_DIR "/models/general.safetensors");
  const auto pieces = std::count_if(recipes.begin(), recipes.end(), [&](const PieceRecipe& recipe) {
    const PointCloud cloud = generate(recipe, kHeldOutSeed).cloud;
    const auto traits = detect::traits_for(model, detect::prepare(cloud));
    return traits.points == detect::CloudTraits{}.points;
  });
  return static_cast<double>(pieces) / static_cast<double>(recipes.size());
}

/// `most` of the recipes of pieces or of wholes, at equal steps; of terrains those made soonest.
std::vector<PieceRecipe> some_of(bool pieces, std::size_t most) {
  std::vector<PieceRecipe> all = piece_recipes(kHeldOutSeed), some;
  std::erase_if(all, [&](const PieceRecipe& recipe) {
    const auto* terrain = std::get_if<TerrainRecipe>(&recipe.whole);
    return (recipe.points > 0) != pieces || (terrain && terrain->points > 20000);
  });
  for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
  return some;
}

TEST(ShippedModels, GeneralTellsPiecesOfScansFromWholeThings) {
  EXPECT_GT(share_of_pieces(some_of(true, 40)), 0.94);
  EXPECT_LT(share_of_pieces(some_of(false, 120)), 0.06);
}

TEST(ShippedModels, GeneralFindsTheAcuteEdgesOfATetrahedron) {
  const std::array<Vec3, 4> corners = {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1),
                                       Vec3(-1, -1, 1)};
  Random random(3);
  PointCloud cloud;
  constexpr std::size_t kPoints = 4000;
  std::vector<double> distances;  // to the edges of its face, in spacings
  const double spacing = std::sqrt(8.0 * std::sqrt(3.0) / kPoints);
  while (cloud.size() < kPoints) {
    const std::size_t face = cloud.size() % 4;
    const double a = random.uniform(), b = random.uniform();
    if (a + b > 1.0) continue;
    const Vec3 &first = corners[(face + 1) % 4], &second = corners[(face + 2) % 4];
    const Vec3& third = corners[(face + 3) % 4];
    cloud.positions.push_back(first + a * (second - first) + b * (third - first));
    cloud.normals.push_back(-corners[face].normalized());
    distances.push_back(std::min({a, b, 1.0 - a - b}) * std::sqrt(6.0) / spacing);
  }
  const auto model = detect::load_model(PCEDNET_SOURCE_DIR "/models/general.safetensors");
  const detect::PreparedCloud prepared = detect::prepare(cloud);
  const detect::Classification found = detect::classify(prepared, model);
  const auto described = detect::describe(prepared, model.descriptor);
  EXPECT_EQ(detect::classify(described, cloud.positions, model).classes, found.classes);
  std::size_t near = 0, sharp = 0, far = 0, wrong = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const bool edge = found.classes[i] != kNonEdge;
    near += distances[i] < 0.4, sharp += distances[i] < 0.4 && found.classes[i] == kSharpEdge;
    far += distances[i] > 2.5, wrong += distances[i] > 2.5 && edge;
  }
  EXPECT_GT(static_cast<double>(sharp), 0.9 * static_cast<double>(near));
  EXPECT_LT(static_cast<double>(wrong), 0.005 * static_cast<double>(far));
}

/// The share of the points of rough ground and plants that `model` calls sharp-edge.
double sharp_share_of_plants(const std::string& model) {
  const auto loaded = detect::load_model(PCEDNET_SOURCE_DIR "/models/" + model + ".safetensors");
  std::size_t sharp = 0, points = 0;
  for (TerrainRecipe recipe : terrain_recipes(kHeldOutSeed)) {
    if (recipe.points > 15000) continue;
    recipe.houses = 0;
    const PointCloud cloud = generate(recipe, kHeldOutSeed).cloud;
    const auto found = detect::classify(detect::prepare(cloud), loaded);
    sharp += static_cast<std::size_t>(
        std::count(found.classes.begin(), found.classes.end(), kSharpEdge));
    points += cloud.size();
  }
  EXPECT_GT(points, 50000u);
  return static_cast<double>(sharp) / static_cast<double>(points);
}

TEST(ShippedModels, GeneralFindsHardlyAnEdgeOnPlants) {
  EXPECT_LT(sharp_share_of_plants("general"), 0.012);
  EXPECT_GT(sharp_share_of_plants("cad"), 0.05);
}

}  // namespace
}  // namespace pcednet::shapes
