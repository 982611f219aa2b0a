#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/classify.h"
#include "pcednet/gls/engine/scale_space.h"
#include "pcednet/gls/scales.h"
#include "workbench/shapes/default_set.h"

// The default model's labels do not depend on the extent of a file: its scales are multiples of the
// spacing.

namespace pcednet::shapes {
namespace {

const detect::EdgeModel& default_model() {
  static const auto model = detect::load_model(PCEDNET_SOURCE_DIR "/models/general.safetensors");
  return model;
}

/// The wall with evenly drawn points, of a seed that no model has seen.
PointCloud wall_of(std::size_t points) {
  for (Recipe& recipe : default_recipes(11)) {
    if (recipe.name != "x_wall_0") continue;
    recipe.points = points;
    return generate(recipe, 11).cloud;
  }
  return {};
}

const PointCloud& wall() {
  static const PointCloud cloud = wall_of(25000);
  return cloud;
}

detect::Classification labels_of(const PointCloud& cloud, const detect::EdgeModel& model) {
  return detect::classify(detect::prepare(cloud), model);
}

gls::ScaleRange range_of(const PointCloud& cloud) {
  const auto prepared = detect::prepare(cloud);
  const gls::ScaleSpace space({prepared.positions, prepared.normals, prepared.curve},
                              default_model().descriptor);
  return space.range();
}

/// The share of points that keep their labels when the cloud is cut into n x n pieces along its two
/// longest axes, each with a halo of the largest scale, and `model` labels each piece.
double share_kept(const PointCloud& cloud, int n, double halo, const detect::EdgeModel& model) {
  const auto whole = labels_of(cloud, default_model()).classes;
  BoundingBox box = bounding_box(cloud.positions);
  const Vec3 extent = box.max - box.min;
  int flat = 0;
  extent.minCoeff(&flat);
  const int u = (flat + 1) % 3, v = (flat + 2) % 3;
  const auto cell_of = [&](const Vec3& p, int axis) {
    return std::clamp(static_cast<int>(n * (p[axis] - box.min[axis]) / extent[axis]), 0, n - 1);
  };
  std::size_t kept = 0;
  for (int i = 0; i < n * n; ++i) {
    const auto in_reach = [&](const Vec3& p, int axis, int cell) {
      const double low = box.min[axis] + cell * extent[axis] / n;
      return p[axis] > low - halo && p[axis] < low + extent[axis] / n + halo;
    };
    PointCloud piece;
    std::vector<std::size_t> core;  // their places in the cloud, or none
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      const Vec3& p = cloud.positions[k];
      if (!in_reach(p, u, i / n) || !in_reach(p, v, i % n)) continue;
      piece.positions.push_back(p);
      piece.normals.push_back(cloud.normals[k]);
      core.push_back(cell_of(p, u) == i / n && cell_of(p, v) == i % n ? k : cloud.size());
    }
    const auto found = labels_of(piece, model).classes;
    for (std::size_t k = 0; k < core.size(); ++k) {
      kept += core[k] < cloud.size() && found[k] == whole[core[k]];
    }
  }
  return static_cast<double>(kept) / static_cast<double>(cloud.size());
}

TEST(CutCloud, KeepsItsLabels) {
  const gls::ScaleRange range = range_of(wall());
  detect::EdgeModel given = default_model();
  given.descriptor.range.s_min = range.s_min;
  given.descriptor.range.s_max = range.s_max;
  for (const int n : {2, 4}) EXPECT_GE(share_kept(wall(), n, range.s_max, given), 0.995) << n;
  EXPECT_GE(share_kept(wall(), 2, range.s_max, default_model()), 0.97);
  // Pieces of fewer points than 4,000 would be left to the networks for sparse clouds.
  const PointCloud large = wall_of(100000);
  EXPECT_GE(share_kept(large, 4, range_of(large).s_max, default_model()), 0.97);
}

TEST(CutCloud, AThrownPointChangesHardlyALabel) {
  PointCloud thrown = wall();
  thrown.labels.clear();
  const auto before = labels_of(thrown, default_model()).classes;
  const BoundingBox box = bounding_box(thrown.positions);
  thrown.positions.push_back(box.max + 20.0 * (box.max - box.min));
  thrown.normals.push_back(Vec3::UnitZ());
  const auto after = labels_of(thrown, default_model()).classes;
  std::size_t same = 0;
  for (std::size_t i = 0; i < before.size(); ++i) same += before[i] == after[i];
  EXPECT_GE(static_cast<double>(same), 0.995 * static_cast<double>(before.size()));
}

}  // namespace
}  // namespace pcednet::shapes
