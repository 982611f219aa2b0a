#include "workbench/shapes/cad_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "pcednet/core/parallel.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/varied_set.h"

namespace pcednet::shapes {
namespace {

Solid cube_part() {
  Solid part;
  part.add(box(0.5, 0.5, 0.5, Vec3::Zero()));
  return part;
}

MeshVertices vertices_of(const Solid& part, const MeshStyle& style) {
  const SolidSamples samples = sample_solid(part, 12 * style.points, 4);
  return mesh_vertices(samples, find_borders(part, samples), part, style, 5);
}

TEST(MeshVertices, AreOnEdgesWhereTheyAreSharp) {
  const MeshVertices vertices = vertices_of(cube_part(), {.points = 3000});
  std::size_t sharp = 0;
  for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
    const Vec3 p = vertices.positions[i].cwiseAbs();
    const int faces = (std::abs(p.x() - 0.5) < 1e-8) + (std::abs(p.y() - 0.5) < 1e-8) +
                      (std::abs(p.z() - 0.5) < 1e-8);
    EXPECT_EQ(vertices.labels[i] == kSharpEdge, faces >= 2) << p.transpose();
    if (faces == 2) {
      // Half-way between the faces' normals.
      EXPECT_NEAR(vertices.normals[i].cwiseAbs().maxCoeff(), std::sqrt(0.5), 1e-4);
      ++sharp;
    }
  }
  EXPECT_GT(sharp, 100u);
  EXPECT_NEAR(static_cast<double>(vertices.positions.size()), 3000.0, 900.0);
}

TEST(MeshVertices, AreEvenAlongEdges) {
  const MeshVertices vertices = vertices_of(cube_part(), {.points = 3000, .plane_limit = 1.0});
  std::vector<Vec3> sharp;
  for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
    if (vertices.labels[i] == kSharpEdge) sharp.push_back(vertices.positions[i]);
  }
  const spatial::KdTree tree(sharp);
  std::vector<double> steps;
  std::vector<spatial::Neighbour> near;
  for (const Vec3& p : sharp) {
    tree.nearest(p, 2, near);
    steps.push_back(std::sqrt(near[1].sq_distance));
  }
  std::sort(steps.begin(), steps.end());
  const double median = steps[steps.size() / 2];
  EXPECT_GT(steps.front(), 0.65 * median);
  EXPECT_LT(steps[steps.size() * 95 / 100], 1.5 * median);  // where two walks meet
}

TEST(MeshVertices, ThinOutOnPlanesWhenAskedTo) {
  const auto share_near_edges = [](const MeshVertices& vertices) {
    std::size_t near = 0;
    for (const Vec3& p : vertices.positions) {
      Vec3 a = p.cwiseAbs();
      std::sort(a.begin(), a.end());
      near += a[1] > 0.35;
    }
    return static_cast<double>(near) / static_cast<double>(vertices.positions.size());
  };
  const double even =
      share_near_edges(vertices_of(cube_part(), {.points = 3000, .plane_growth = 0}));
  const double thinned =
      share_near_edges(vertices_of(cube_part(), {.points = 3000, .plane_growth = 0.6}));
  EXPECT_GT(thinned, 1.3 * even);
}

TEST(CadSet, HasNamesOfItsOwnAndEveryKindOfCloud) {
  for (const auto& recipes : {cad_recipes(1), worn_recipes(1)}) {
    std::set<std::string> names;
    std::size_t mesh = 0, estimated = 0, inward = 0;
    for (const CadRecipe& recipe : recipes) {
      names.insert(recipe.name);
      mesh += recipe.mesh, estimated += recipe.estimated, inward += recipe.inward;
    }
    EXPECT_EQ(names.size(), recipes.size());
    for (const std::size_t some : {mesh, estimated, inward}) {
      EXPECT_GT(some, 0u);
      EXPECT_LT(some, recipes.size());
    }
  }
}

TEST(CadSet, LabelsTheBandBesideASharpEdge) {
  const SolidSamples samples = sample_solid(cube_part(), 12 * 3000, 4);
  const auto borders = find_borders(cube_part(), samples);
  const MeshVertices drawn = drawn_points(samples, borders, 3000, {.sharp = 0.6, .smooth = 1.73});
  const double spacing = std::sqrt(6.0 / 3000.0);
  std::size_t of_class[3] = {}, agreeing = 0;
  for (std::size_t i = 0; i < drawn.positions.size(); ++i) {
    Vec3 beside = (Vec3::Constant(0.5) - drawn.positions[i].cwiseAbs()).cwiseAbs();
    std::sort(beside.begin(), beside.end());
    const double distance = std::hypot(beside[0], beside[1]) / spacing;
    const std::uint8_t label = drawn.labels[i];
    ++of_class[label];
    const EdgeClass expected = distance < 0.6    ? kSharpEdge
                               : distance < 1.73 ? kSmoothEdge
                                                 : kNonEdge;
    agreeing += label == expected;
  }
  // The borders are points some way apart.
  EXPECT_GT(static_cast<double>(agreeing), 0.97 * static_cast<double>(drawn.positions.size()));
  for (const std::size_t some : of_class) EXPECT_GT(some, 100u);
}

/// The sharp points of a recipe's cloud, and those that are nearest to a place on its curves.
struct SharpPoints {
  std::set<std::uint32_t> labelled, nearest;
};

SharpPoints sharp_points(const CadRecipe& recipe) {
  constexpr double kStep = 2e-4;  // parts are a unit large
  const GeneratedCloud made = generate(recipe, 1);
  SharpPoints sharp;
  for (std::uint32_t i = 0; i < made.cloud.size(); ++i) {
    if (made.cloud.labels[i] == kSharpEdge) sharp.labelled.insert(i);
  }
  const spatial::KdTree tree(made.cloud.positions);
  std::vector<spatial::Neighbour> near;
  for (const lines::Curve& curve : made.curves) {
    const std::vector<Vec3> chain = lines::sampled(curve, kStep);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const double places = std::ceil((chain[i] - chain[i - 1]).norm() / kStep);
      for (double place = 0.0; place <= places; ++place) {
        tree.nearest(chain[i - 1] + place / places * (chain[i] - chain[i - 1]), 1, near);
        sharp.nearest.insert(near.front().index);
      }
    }
  }
  return sharp;
}

TEST(SparseSet, SharpAreThePointsNearestToTheTrueCurves) {
  std::size_t labelled = 0, nearest = 0, both = 0;
  std::vector<CadRecipe> recipes = sparse_part_recipes(1);
  std::erase_if(recipes, [](const CadRecipe& recipe) {
    return recipe.style.points > 800 || recipe.scatter > 0.0 || !recipe.even;
  });
  ASSERT_GT(recipes.size(), 10u);
  recipes.resize(10);
  for (const CadRecipe& recipe : recipes) {
    const SharpPoints sharp = sharp_points(recipe);
    labelled += sharp.labelled.size(), nearest += sharp.nearest.size();
    for (const std::uint32_t point : sharp.labelled) both += sharp.nearest.contains(point);
  }
  // Places are finite: cells that a curve hardly touches may differ.
  EXPECT_GT(static_cast<double>(both), 0.97 * static_cast<double>(labelled));
  EXPECT_GT(static_cast<double>(both), 0.97 * static_cast<double>(nearest));
}

TEST(VariedSet, ReachesFromAThousandPointsToManyAndIsNoisy) {
  std::set<std::string> names;
  std::size_t sparse = 0, noisy = 0;
  const auto recipes = varied_part_recipes(1);
  for (const CadRecipe& recipe : recipes) {
    names.insert(recipe.name);
    sparse += recipe.style.points<2000, noisy += recipe.scatter> 0.0 || recipe.noise > 0.0;
    EXPECT_TRUE(recipe.estimated);
  }
  EXPECT_EQ(names.size(), recipes.size());
  EXPECT_GT(sparse, recipes.size() / 2);
  EXPECT_GT(noisy, recipes.size() / 4);
}

TEST(VariedSet, EvenPartsHaveNoPointsNearEachOther) {
  for (const CadRecipe& recipe : varied_part_recipes(1)) {
    if (!recipe.even || recipe.scatter > 0.0 || recipe.style.points > 900) continue;
    CadRecipe uneven = recipe;
    uneven.even = false;
    const auto least_distance = [](const PointCloud& cloud) {
      const spatial::KdTree tree(cloud.positions);
      std::vector<spatial::Neighbour> near;
      double least = 1e9;
      for (const Vec3& p : cloud.positions) {
        tree.nearest(p, 2, near);
        least = std::min(least, std::sqrt(near[1].sq_distance));
      }
      return least;
    };
    const PointCloud even = generate(recipe, 1).cloud;
    EXPECT_GT(least_distance(even), 5.0 * least_distance(generate(uneven, 1).cloud)) << recipe.name;
    EXPECT_LT(even.size(), 1.2 * static_cast<double>(recipe.style.points));
    EXPECT_GT(even.size(), 0.4 * static_cast<double>(recipe.style.points));  // thin: few
  }
}

TEST(VariedSet, ThinnedCloudsKeepLabelsAndNormals) {
  const Recipe recipe = thinned_recipes(1).front();
  Recipe dense = recipe;
  dense.thinned = 1;
  const PointCloud some = generate(recipe, 1).cloud, all = generate(dense, 1).cloud;
  EXPECT_NEAR(static_cast<double>(some.size() * recipe.thinned) / static_cast<double>(all.size()),
              1.0, 0.15);
  const auto share = [](const PointCloud& cloud) {
    return static_cast<double>(std::count(cloud.labels.begin(), cloud.labels.end(), kSharpEdge)) /
           static_cast<double>(cloud.size());
  };
  EXPECT_NEAR(share(some) / share(all), 1.0, 0.3);
  EXPECT_EQ(some.normals.size(), some.size());
  EXPECT_EQ(some.labels.size(), some.size());
}

TEST(CadSet, GivesTheSameCloudForAnyNumberOfThreads) {
  CadRecipe recipe = cad_recipes(3)[5];
  recipe.style.points = 800;
  recipe.noise = 0.002;
  CadRecipe worn = worn_recipes(3)[5];
  worn.style.points = 800;
  for (const CadRecipe& each : {recipe, worn}) {
    set_thread_count(1);
    const GeneratedCloud one = generate(each, 3);
    set_thread_count(8);
    const GeneratedCloud eight = generate(each, 3);
    set_thread_count(0);
    EXPECT_EQ(one.cloud.positions, eight.cloud.positions);
    EXPECT_EQ(one.cloud.normals, eight.cloud.normals);
    EXPECT_EQ(one.cloud.labels, eight.cloud.labels);
    EXPECT_NE(generate(each, 4).cloud.positions, one.cloud.positions);
  }
}

TEST(CadSet, RoundsWornEdgesOff) {
  CadRecipe sharp = {.name = "a", .family = 5, .part = 1, .style = {.points = 2000}};
  CadRecipe worn = sharp;
  worn.wear = 2.0;
  // The least agreement between the normals of neighbours.
  const auto roughness = [](const PointCloud& cloud) {
    const spatial::KdTree tree(cloud.positions);
    std::vector<spatial::Neighbour> near;
    double sum = 0.0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      tree.nearest(cloud.positions[i], 7, near);
      double least = 1.0;
      for (const auto& n : near)
        least = std::min(least, cloud.normals[n.index].dot(cloud.normals[i]));
      sum += 1.0 - least;
    }
    return sum / static_cast<double>(cloud.size());
  };
  EXPECT_LT(roughness(generate(worn, 1).cloud), 0.7 * roughness(generate(sharp, 1).cloud));
}

}  // namespace
}  // namespace pcednet::shapes
