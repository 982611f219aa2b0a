#include "workbench/shapes/cad_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/random.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/solids/cad_parts.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/surfaces/sampling.h"
#include "workbench/shapes/true_curves.h"
#include "workbench/shapes/wear.h"

namespace pcednet::shapes {
namespace {

constexpr std::size_t kSolidSamplesPerPoint = 12;

std::vector<Vec3> sharp_edges(std::span<const BorderPoint> borders) {
  std::vector<Vec3> edges;
  for (const BorderPoint& border : borders) {
    if (border.turn() >= kSharpTurn) edges.push_back(border.position);
  }
  return edges;
}

}  // namespace

std::vector<std::uint8_t> label_bands(std::span<const Vec3> positions,
                                      std::span<const BorderPoint> borders,
                                      const EdgeBands& bands) {
  const spatial::KdTree tree(sharp_edges(borders));
  std::vector<std::uint8_t> labels;
  std::vector<spatial::Neighbour> nearest;
  for (const Vec3& position : positions) {
    tree.nearest(position, 1, nearest);
    labels.push_back(nearest.empty() ? kNonEdge
                                     : class_at(std::sqrt(nearest.front().sq_distance), bands));
  }
  return labels;
}

MeshVertices drawn_points(const SolidSamples& samples, std::span<const BorderPoint> borders,
                          std::size_t most, const EdgeBands& bands) {
  const std::size_t count = std::min(most, samples.points.size());
  const double spacing = std::sqrt(samples.area / static_cast<double>(count));
  MeshVertices drawn;
  for (std::size_t i = 0; i < count; ++i) {
    drawn.positions.push_back(samples.points[i].position);
    drawn.normals.push_back(samples.points[i].normal);
  }
  drawn.labels = label_bands(drawn.positions, borders, spacing * bands);
  return drawn;
}

namespace {

/// Makes the points nearest to some place on a curve sharp-edge, and the other former edge points
/// smooth-edge: a line one point wide, regardless of the points between the places.
void label_nearest(MeshVertices& vertices, std::span<const lines::Curve> curves, double spacing) {
  constexpr double kStep = 0.05;  // between places, in spacings
  for (std::uint8_t& label : vertices.labels) {
    if (label == kSharpEdge) label = kSmoothEdge;
  }
  const spatial::KdTree tree(vertices.positions);
  std::vector<spatial::Neighbour> nearest;
  for (const lines::Curve& curve : curves) {
    const std::vector<Vec3> chain = lines::sampled(curve, kStep * spacing);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Vec3 along = chain[i] - chain[i - 1];
      const double places = std::ceil(along.norm() / (kStep * spacing));
      for (double place = 0.5; place < places; ++place) {
        tree.nearest(chain[i - 1] + place / places * along, 1, nearest);
        vertices.labels[nearest.front().index] = kSharpEdge;
      }
    }
  }
}

/// Vertices on no sharp border are smooth-edge within `band` of one.
void label_beside(MeshVertices& vertices, std::span<const BorderPoint> borders, double band) {
  const auto labels = label_bands(vertices.positions, borders, {0.0, band});
  for (std::size_t i = 0; i < labels.size(); ++i) {
    vertices.labels[i] = std::max(vertices.labels[i], labels[i]);
  }
}

/// About `points` of the samples, none near another: as thinned by the usual tools.
SolidSamples spread(const SolidSamples& samples, std::size_t points) {
  constexpr double kFill = 0.7;  // number times distance squared, over the area
  const double distance = std::sqrt(kFill * samples.area / static_cast<double>(points));
  const spatial::KdTree tree(positions_of(samples.points));
  std::vector<char> free(samples.points.size(), 1);
  std::vector<spatial::Neighbour> near;
  SolidSamples spread = {{}, samples.area};
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    if (!free[i]) continue;
    spread.points.push_back(samples.points[i]);
    tree.within(samples.points[i].position, distance, near);
    for (const spatial::Neighbour& neighbour : near) free[neighbour.index] = 0;
  }
  return spread;
}

/// The vertices of a worn part, labelled and rounded off.
void wear_off(MeshVertices& vertices, const SolidSamples& samples,
              std::span<const BorderPoint> borders, const CadRecipe& recipe, double spacing,
              Random& random) {
  SurfaceSamples surface = {positions_of(samples.points), {}};
  for (const FacePoint& point : samples.points) surface.normals.push_back(point.normal);
  const std::vector<Vec3> edges = sharp_edges(borders);
  wear_off(vertices, surface, edges,
           {recipe.wear * spacing, spacing * recipe.bands, recipe.scatter * spacing,
            random.uniform(0.0, 0.5) * spacing},
           random);
}

}  // namespace

MeshStyle random_mesh_style(Random& random, double least, double most) {
  MeshStyle style;
  style.points = points_between(random, least, most);
  style.plane_growth = random.uniform(0.0, 0.6);
  style.plane_limit = random.uniform(1.0, 6.0);
  style.curved_spacing = random.uniform(0.6, 1.4);
  style.smooth_borders = random.index(3) != 0;
  return style;
}

CadRecipe drawn_part(const std::string& set, int family, int number, std::uint64_t first_part,
                     Random& random) {
  CadRecipe recipe;
  recipe.name = fmt::format("{}_{}_{}", set, part_family_name(family), number);
  recipe.family = family;
  recipe.part = first_part + static_cast<std::uint64_t>(number);
  recipe.estimated = true;
  recipe.inward = random.index(2) == 1;
  recipe.mesh = false;
  return recipe;
}

std::vector<CadRecipe> parts_of_each_family(int parts,
                                            const std::function<CadRecipe(int, int)>& make) {
  std::vector<CadRecipe> recipes;
  for (int number = 0; number < parts; ++number) {
    for (int family = 0; family < kPartFamilies; ++family) recipes.push_back(make(family, number));
  }
  return recipes;
}

std::vector<CadRecipe> cad_recipes(std::uint64_t seed) {
  constexpr int kPartsPerFamily = 7;
  std::vector<CadRecipe> recipes;
  for (int part = 0; part < kPartsPerFamily; ++part) {
    for (int family = 0; family < kPartFamilies; ++family) {
      CadRecipe recipe;
      recipe.name = fmt::format("{}_{}", part_family_name(family), part);
      recipe.family = family;
      recipe.part = static_cast<std::uint64_t>(part);
      Random random(seed, 9000 + recipes.size());
      recipe.style = random_mesh_style(random, 1500, 18000);
      recipe.estimated = part % 2 == 1;
      recipe.inward = random.index(2) == 1;
      if (part == 5) recipe.mesh = false;
      if (part == 6) recipe.noise = random.uniform(0.001, 0.006);
      recipes.push_back(recipe);
    }
  }
  return recipes;
}

std::vector<CadRecipe> worn_recipes(std::uint64_t seed) {
  std::vector<CadRecipe> recipes = cad_recipes(seed + 1000);
  for (std::size_t i = 0; i < recipes.size(); ++i) {
    CadRecipe& recipe = recipes[i];
    Random random(seed, 19000 + i);
    recipe.name = "worn_" + recipe.name;
    recipe.mesh = random.index(4) != 0;
    recipe.style.points = points_between(random, 3000, 12000);
    recipe.style.plane_limit = random.index(2) ? 1.0 : random.uniform(1.0, 3.0);
    recipe.style.curved_spacing = 1.0;
    recipe.style.smooth_borders = false;
    recipe.noise = 0.0;
    recipe.wear = std::max(0.05, random.uniform(-0.5, 3.0));
    recipe.bands = worn_bands(0.5 + 0.4 * recipe.wear);
    recipe.scatter = random.index(2) ? 0.0 : random.uniform(0.0, 0.15);
    recipe.estimated = random.index(3) == 0;
  }
  return recipes;
}

GeneratedCloud generate(const CadRecipe& recipe, std::uint64_t seed) {
  Random shapes(seed, 100 * static_cast<std::uint64_t>(recipe.family) + recipe.part);
  const Solid solid = random_part(recipe.family, shapes);
  Random random(seed, 50000 + 100 * static_cast<std::uint64_t>(recipe.family) + recipe.part);
  SolidSamples samples =
      sample_solid(solid, kSolidSamplesPerPoint * recipe.style.points, random.next());
  const std::vector<BorderPoint> borders = find_borders(solid, samples);
  std::vector<lines::Curve> curves = true_curves(solid, borders);
  if (recipe.even) samples = spread(samples, recipe.style.points);
  MeshVertices vertices = recipe.mesh
                              ? mesh_vertices(samples, borders, solid, recipe.style, random.next())
                              : drawn_points(samples, borders, recipe.style.points, recipe.bands);
  const double spacing = std::sqrt(samples.area / static_cast<double>(vertices.positions.size()));
  if (recipe.one_point_wide) label_nearest(vertices, curves, spacing);
  if (recipe.wear > 0.0) {
    wear_off(vertices, samples, borders, recipe, spacing, random);
  } else {
    if (recipe.mesh) label_beside(vertices, borders, recipe.bands.smooth * spacing);
    if (recipe.scatter > 0.0) add_noise(vertices.positions, recipe.scatter * spacing, random);
  }
  if (recipe.noise > 0.0) {
    const double sigma = recipe.noise * bounding_box(vertices.positions).diagonal();
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
      vertices.positions[i] += sigma * random.normal() * vertices.normals[i];
    }
  }
  const Mat3 rotation = gaussian_rotation(random);
  PointCloud cloud = finish(std::move(vertices), {recipe.estimated, recipe.inward}, rotation);
  cloud.comments = {
      fmt::format("generated by pcednet: {}, seed {}", recipe.name, seed),
      fmt::format("{}; noise {:.2g} of the diagonal along normals, which are {}{}",
                  recipe.mesh ? "vertices as of a mesh" : "points drawn by area", recipe.noise,
                  recipe.estimated ? "estimated" : "of the part", recipe.inward ? ", inward" : "")};
  return {recipe.name, std::move(cloud), rotated(std::move(curves), rotation)};
}

}  // namespace pcednet::shapes
