#include "workbench/shapes/scan_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/spatial/kd_tree.h"
#include "workbench/shapes/surfaces/sampling.h"
#include "workbench/shapes/true_curves.h"

namespace pcednet::shapes {
namespace {

/// The class of a point from the borders near it; each represents a short straight piece of edge.
std::uint8_t label_of(const Vec3& position, double spacing, const spatial::KdTree& tree,
                      std::span<const BorderPoint> borders, const EdgeBands& bands,
                      std::vector<spatial::Neighbour>& near) {
  constexpr double kSharpDegrees = 30.0, kSmoothDegrees = 12.0;
  tree.within(position, 3.0 * spacing, near);
  std::uint8_t label = kNonEdge;
  for (const spatial::Neighbour& neighbour : near) {
    const BorderPoint& border = borders[neighbour.index];
    const double turn = border.turn() * 180.0 / std::numbers::pi;
    if (turn < kSmoothDegrees) continue;
    const Vec3 along = border.normal_a.cross(border.normal_b).normalized();
    const Vec3 offset = position - border.position;
    const double distance = (offset - offset.dot(along) * along).norm();
    if (distance < bands.sharp * spacing && turn >= kSharpDegrees) return kSharpEdge;
    if (distance < bands.smooth * spacing) label = kSmoothEdge;
  }
  return label;
}

std::vector<BorderPoint> borders_of(const Scan& scan, const Solid& solid) {
  std::vector<Vec3> on_solid;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (scan.kinds[i] == ReturnKind::kSolid) on_solid.push_back(scan.positions[i]);
  }
  return borders_among(solid, on_solid);
}

std::vector<std::uint8_t> label_scan(const Scan& scan, std::span<const BorderPoint> borders,
                                     std::span<const double> spacings, const EdgeBands& bands) {
  std::vector<Vec3> places;
  for (const BorderPoint& border : borders) places.push_back(border.position);
  const spatial::KdTree tree(places);
  // Leaves return no border; points off the solid by mistake have no truth.
  std::vector<std::uint8_t> labels(scan.positions.size(), kNonEdge);
  parallel_blocks(labels.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      if (scan.kinds[i] == ReturnKind::kStray) labels[i] = kUnlabelled;
      if (scan.kinds[i] != ReturnKind::kSolid) continue;
      labels[i] = label_of(scan.positions[i], spacings[i], tree, borders, bands, near);
    }
  });
  return labels;
}

/// Whether no scan has the surface where the scanner of point i sees no more of it.
bool is_end(const Scan& scan, std::size_t i, double spacing, const spatial::KdTree& tree,
            std::vector<spatial::Neighbour>& near) {
  constexpr double kAround = 3.0, kBeyond = 0.5;  // in spacings
  constexpr std::ptrdiff_t kSeen = 2;             // points of other scans
  if (scan.open_sides[i].isZero(0.0)) return false;
  const Vec3 open = scan.open_sides[i].normalized();
  tree.within(scan.positions[i], kAround * spacing, near);
  return std::count_if(near.begin(), near.end(), [&](const spatial::Neighbour& other) {
           const std::size_t j = other.index;
           return scan.places[j] != scan.places[i] && scan.kinds[j] == ReturnKind::kSolid &&
                  (scan.positions[j] - scan.positions[i]).dot(open) > kBeyond * spacing;
         }) < kSeen;
}

/// Labels non-edge points of the solid where the surface that was scanned ends.
void label_ends(const Scan& scan, std::span<const double> spacings,
                std::span<std::uint8_t> labels) {
  const spatial::KdTree tree(scan.positions);
  parallel_blocks(labels.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      if (labels[i] != kNonEdge || scan.kinds[i] != ReturnKind::kSolid) continue;
      if (is_end(scan, i, spacings[i], tree, near)) labels[i] = kBoundary;
    }
  });
}

}  // namespace

std::vector<ScanRecipe> scan_recipes(std::uint64_t seed) {
  constexpr std::uint64_t kScenes = 6;
  std::vector<ScanRecipe> recipes;
  for (std::uint64_t scene = 0; scene < kScenes; ++scene) {
    for (int kind = 0; kind < kSceneKinds; ++kind) {
      ScanRecipe recipe;
      recipe.name = fmt::format("scan_{}_{}", scene_kind_name(kind), scene);
      recipe.kind = kind;
      recipe.scene = scene;
      Random random(seed, 31000 + recipes.size());
      recipe.scanner.places = 1 + random.index(3);
      recipe.scanner.rays =
          static_cast<std::size_t>(random.uniform(12000.0, 45000.0)) / recipe.scanner.places;
      recipe.scanner.range_noise = 0.001 * std::pow(12.0, random.uniform());
      recipe.scanner.misalignment = random.index(2) ? 0.0 : random.uniform(0.0, 0.015);
      recipe.scanner.outliers = random.index(2) ? 0.0 : 0.002;
      recipes.push_back(recipe);
    }
  }
  return recipes;
}

GeneratedCloud generate(const ScanRecipe& recipe, std::uint64_t seed) {
  const auto stream = 100 * static_cast<std::uint64_t>(recipe.kind) + recipe.scene;
  Random random(seed, 70000 + stream);
  const Scene scene = random_scene(recipe.kind, random);
  const Scan scan = scan_scene(scene, recipe.scanner, random.next());
  PointCloud cloud;
  const std::vector<BorderPoint> borders = borders_of(scan, scene.solid);
  const std::vector<double> spacings = local_spacings(scan.positions);
  cloud.labels = label_scan(scan, borders, spacings, recipe.bands);
  label_ends(scan, spacings, cloud.labels);
  for (const Vec3& position : scan.positions) {
    cloud.positions.push_back(position.cast<float>().cast<double>());
  }
  cloud.normals = oriented_normals(cloud.positions);
  cloud.position_type = ScalarType::kFloat32;
  cloud.comments = {
      fmt::format("generated by pcednet: {}, seed {}", recipe.name, seed),
      fmt::format("scanned from {} places, range noise {:.2g}, misaligned by {:.2g}",
                  recipe.scanner.places, recipe.scanner.range_noise, recipe.scanner.misalignment)};
  std::vector<lines::Curve> curves = true_curves(scene.solid, borders);
  drop_unseen(curves, scan.positions, 2.0 * median(spacings));
  return {recipe.name, std::move(cloud), std::move(curves)};
}

}  // namespace pcednet::shapes
