#include "workbench/shapes/line_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/acquisition.h"
#include "workbench/shapes/cad_parts.h"
#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/roofs.h"
#include "workbench/shapes/sampling.h"
#include "workbench/shapes/scanner.h"
#include "workbench/shapes/true_curves.h"
#include "workbench/shapes/wear.h"

namespace pcednet::shapes {
namespace {

constexpr std::size_t kSamplesPerPoint = 4;
constexpr double kBand = 0.6;             // of the label sharp-edge, in spacings
constexpr std::uint64_t kFirstPart = 50;  // after those of other sets

/// Twelve scanners around the solid: diagonally above and below, and level.
std::vector<ScanPlace> places_around(const Solid& solid) {
  constexpr double kDistance = 1.4;
  const Vec3 centre = solid.box().centre();
  std::vector<ScanPlace> places;
  const auto add = [&](const Vec3& direction) {
    places.push_back({centre + kDistance * direction.normalized(), centre});
  };
  for (int i = 0; i < 8; ++i) add({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  for (const double side : {-1.0, 1.0}) add({side, 0.1 * side, 0.0}), add({0.1 * side, side, 0.0});
  return places;
}

/// At most `points` returns, and about as many unless little of the part can be seen.
Scan scan_part(const Solid& solid, std::size_t points, double spacing, Random& random) {
  constexpr std::size_t kTrialRays = 4000, kMostRays = 200000;
  const Scene scene = {solid, {}, places_around(solid)};
  ScannerOptions options{.rays = kTrialRays,
                         .range = 3.0,
                         .range_noise = 0.25 * spacing,
                         .misalignment = 0.1 * spacing,
                         .places = scene.scanners.size()};
  const Scan trial = scan_scene(scene, options, random.next());
  const double share = static_cast<double>(trial.positions.size()) /
                       static_cast<double>(kTrialRays * options.places);
  const double wanted = 1.1 * static_cast<double>(points) / std::max(share, 1e-3);
  options.rays =
      std::min(kMostRays, static_cast<std::size_t>(wanted / static_cast<double>(options.places)));
  Scan scan = scan_scene(scene, options, random.next());
  const std::size_t count = std::min(points, scan.positions.size());
  for (std::size_t i = 0; i < count; ++i) {  // a random choice comes first
    const std::size_t other = i + random.index(scan.positions.size() - i);
    std::swap(scan.positions[i], scan.positions[other]);
    std::swap(scan.kinds[i], scan.kinds[other]);
  }
  scan.positions.resize(count);
  scan.kinds.resize(count);
  return scan;
}

MeshVertices scanned_points(const Solid& solid, const SolidSamples& samples,
                            std::span<const BorderPoint> borders, std::size_t points,
                            Random& random) {
  const double spacing = std::sqrt(samples.area / static_cast<double>(points));
  Scan scan = scan_part(solid, points, spacing, random);
  std::vector<Vec3> edges;
  for (const BorderPoint& border : borders) {
    if (border.turn() >= kSharpTurn) edges.push_back(border.position);
  }
  const spatial::KdTree tree(edges);
  MeshVertices vertices;
  std::vector<spatial::Neighbour> near;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    tree.nearest(scan.positions[i], 1, near);
    const bool sharp = !near.empty() && std::sqrt(near.front().sq_distance) < kBand * spacing;
    const bool stray = scan.kinds[i] == ReturnKind::kStray;
    vertices.labels.push_back(stray ? kUnlabelled : sharp ? kSharpEdge : kNonEdge);
  }
  vertices.positions = std::move(scan.positions);
  vertices.normals.resize(vertices.positions.size(), Vec3::Zero());
  return vertices;
}

GeneratedCloud generate_part(const LineRecipe& recipe, std::uint64_t seed) {
  const std::uint64_t stream =
      100 * static_cast<std::uint64_t>(recipe.family) + kFirstPart + recipe.part;
  Random shapes(seed, stream);
  const Solid solid = random_part(recipe.family, shapes);
  Random random(seed, 90000 + stream);
  const SolidSamples samples = sample_solid(solid, kSamplesPerPoint * recipe.points, random.next());
  const std::vector<BorderPoint> borders = find_borders(solid, samples);
  std::vector<lines::Curve> curves = true_curves(solid, borders);
  const Mat3 rotation = gaussian_rotation(random);
  const double spacing = std::sqrt(samples.area / static_cast<double>(recipe.points));
  const bool scanned = recipe.kind == LineRecipe::Kind::kScanned;
  MeshVertices vertices = scanned ? scanned_points(solid, samples, borders, recipe.points, random)
                                  : drawn_points(samples, borders, recipe.points, kBand);
  if (recipe.kind == LineRecipe::Kind::kNoisy) {
    add_noise(vertices.positions, 0.5 * spacing, random);
  }
  if (scanned) drop_unseen(curves, vertices.positions, 2.0 * spacing);
  PointCloud cloud = finish(std::move(vertices), {}, rotation);
  cloud.normals.clear();
  cloud.comments = {fmt::format("generated by pcednet: {}, seed {}", recipe.name, seed),
                    fmt::format("spacing {:.6g}; no normals", spacing)};
  return {recipe.name, std::move(cloud), rotated(std::move(curves), rotation)};
}

/// As published roofs are: drawn with replacement, so that a third of the points are copies.
GeneratedCloud generate_roof(const LineRecipe& recipe, std::uint64_t seed) {
  constexpr double kNoise = 0.005, kDrawnPerPoint = 1.3;
  Random random(seed, 95000 + 100 * static_cast<std::uint64_t>(recipe.family) + recipe.part);
  const Polyhedron roof = random_roof(recipe.family, random);
  const auto drawn = static_cast<std::size_t>(kDrawnPerPoint * static_cast<double>(recipe.points));
  SurfaceSamples samples = sample_surface(make_shape(roof), {.points = drawn}, random);
  const double spacing =
      std::sqrt(surface_area(make_shape(roof)) / static_cast<double>(recipe.points));
  add_noise(samples.positions, kNoise, random);
  GeneratedCloud result = {recipe.name, {}, lines_of(roof)};
  PointCloud& cloud = result.cloud;
  for (std::size_t i = 0; i < recipe.points; ++i) {
    cloud.positions.push_back(samples.positions[random.index(drawn)]);
  }
  std::vector<EdgeCurve> creases;
  for (const lines::Curve& curve : result.curves) {
    if (curve.edge_class == kSharpEdge)
      creases.push_back({Segment{curve.points[0], curve.points[1]}});
  }
  cloud.labels = label_by_distance(cloud.positions, creases, {kBand * spacing, 0.0});
  cloud.comments = {fmt::format("generated by pcednet: {}, seed {}", recipe.name, seed),
                    "metres; no normals"};
  return result;
}

}  // namespace

std::vector<LineRecipe> line_recipes() {
  constexpr std::uint64_t kParts = 2, kRoofs = 2;
  using Kind = LineRecipe::Kind;
  std::vector<LineRecipe> recipes;
  for (const auto& [kind, suffix] : {std::pair(Kind::kClean, ""), std::pair(Kind::kNoisy, "_noisy"),
                                     std::pair(Kind::kScanned, "_scanned")}) {
    for (std::uint64_t part = 0; part < kParts; ++part) {
      for (int family = 0; family < kPartFamilies; ++family) {
        recipes.push_back(
            {fmt::format("{}_{}{}", part_family_name(family), part, suffix), kind, family, part});
      }
    }
  }
  for (std::uint64_t part = 0; part < kRoofs; ++part) {
    for (int kind = 0; kind < kRoofKinds; ++kind) {
      recipes.push_back(
          {fmt::format("roof_{}_{}", roof_kind_name(kind), part), Kind::kRoof, kind, part, 1024});
    }
  }
  return recipes;
}

GeneratedCloud generate(const LineRecipe& recipe, std::uint64_t seed) {
  return recipe.kind == LineRecipe::Kind::kRoof ? generate_roof(recipe, seed)
                                                : generate_part(recipe, seed);
}

}  // namespace pcednet::shapes
