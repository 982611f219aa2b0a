#include "pcednet/gls/engine/voxel_merge.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>

#include "gls/engine/listed_voxels.h"
#include "gls/test_clouds.h"
#include "pcednet/gls/engine/normal_spread.h"
#include "pcednet/gls/oriented_points.h"

namespace pcednet::gls {
namespace {

/// A cube filled with points whose normals have any direction.
test::Cloud noise(std::size_t count) {
  test::Stream stream(51);
  test::Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = stream.uniform(), y = stream.uniform(), z = stream.uniform();
    cloud.add({x, y, z}, stream.direction());
  }
  return cloud;
}

VoxelArray points_of(const test::Cloud& cloud) {
  const auto order = point_order(cloud.points()).order;
  VoxelPyramid pyramid = make_pyramid(cloud.positions, cloud.normals, order, 1.0);
  return std::move(pyramid.levels.front().voxels);
}

double spread_of(const std::function<Vec3(test::Stream&)>& draw) {
  test::Stream stream(52);
  NormalSpread spread;
  for (int i = 0; i < 4000; ++i) spread.add(draw(stream), 1.0 + stream.uniform());
  return spread.mean_sq_volume();
}

TEST(NormalSpread, IsTheMeanSquareOfTheVolumesOfAllTriples) {
  test::Stream stream(53);
  std::vector<Vec3> normals;
  for (int i = 0; i < 12; ++i) normals.push_back(stream.direction());
  NormalSpread spread;
  for (const Vec3& n : normals) spread.add(n, 1.0);
  double sum = 0.0, triples = 0.0;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < i; ++j) {
      for (int k = 0; k < j; ++k, ++triples) {
        const double volume = normals[i].dot(normals[j].cross(normals[k]));
        sum += volume * volume;
      }
    }
  }
  EXPECT_NEAR(spread.mean_sq_volume(), sum / triples, 1e-12);
}

TEST(NormalSpread, TellsSurfacesAndEdgesFromNoise) {
  EXPECT_NEAR(spread_of([](auto& s) { return s.direction(); }), 2.0 / 9.0, 0.01);
  EXPECT_EQ(spread_of([](auto&) { return Vec3(0, 0, 1); }), 0.0);
  const auto edge = [](auto& s) { return s.uniform() < 0.5 ? Vec3(0, 0, 1) : Vec3(-1, 0, 0); };
  EXPECT_NEAR(spread_of(edge), 0.0, 1e-12);
  const auto rough = [](auto& s) { return (Vec3(0, 0, 1) + 0.1 * s.normal3()).normalized(); };
  EXPECT_NEAR(spread_of(rough), 6e-4, 2e-4);
  EXPECT_EQ(NormalSpread().mean_sq_volume(), 0.0);
}

TEST(VoxelMerge, KeepsFarFewerVoxelsOfNoiseWhereItIsCrowded) {
  const VoxelArray points = points_of(noise(100000));
  MergeCells cells = {.origin = Vec3::Zero(), .side = 1.0, .edge = 0.02, .crowd = Crowd::kKeep};
  const std::size_t kept = merge_voxels(points, cells).size();
  EXPECT_GT(forecast_merge(points, cells).filling, 20.0);
  cells.crowd = Crowd::kMerge;
  const VoxelArray merged = merge_voxels(points, cells);
  EXPECT_LE(merged.size(), 20u * 19 * 19);  // cubes of 0.16 / 3, and cells of blocks at the rim
  EXPECT_LT(merged.size(), kept / 9);
  cells.crowd = Crowd::kMergeByAxis;
  const VoxelArray by_axis = merge_voxels(points, cells);
  EXPECT_LE(by_axis.size(), 6u * 13 * 13 * 14);  // cubes of 0.08, axes, signs
  for (const VoxelSpan voxels : {VoxelSpan(merged), VoxelSpan(by_axis)}) {
    double count = 0.0;
    for (const Voxel& voxel : listed(voxels)) count += voxel.count;
    EXPECT_EQ(count, 100000.0);
  }
  for (const Voxel& voxel : listed(by_axis)) {  // a gate sees directions: means of a sixth of all
    EXPECT_GT(Vec3(voxel.normal[0], voxel.normal[1], voxel.normal[2]).norm(), 0.5);
  }
}

TEST(VoxelMerge, LeavesSurfacesAloneWhereverItIsCrowded) {
  // Edges, corners, both sides in one block, noise of normals: none of them fills space.
  test::Cloud thin = test::cube(40000, 54);
  for (Vec3& p : thin.positions) p.z() *= 0.02;
  for (const test::Cloud& cloud :
       {test::scene(40000, 55), test::cube(40000, 56, 0.003, 0.1), thin}) {
    const VoxelArray points = points_of(cloud);
    MergeCells cells = {.origin = Vec3(-2, -2, -2), .side = 6, .edge = 0.02, .crowd = Crowd::kKeep};
    EXPECT_LT(forecast_merge(points, cells).filling, 4.0);
    const std::size_t kept = merge_voxels(points, cells).size();
    cells.crowd = Crowd::kMerge;
    const std::size_t merged = merge_voxels(points, cells).size();
    EXPECT_GE(merged, kept - kept / 16);  // the corners of the cubes
  }
}

TEST(VoxelPyramid, HoldsFewVoxelsPerNeighbourhoodOfNoiseAsOfASurface) {
  for (const bool gated : {false, true}) {
    const test::Cloud cloud = noise(200000);
    VoxelPyramid pyramid =
        make_pyramid(cloud.positions, cloud.normals, point_order(cloud.points()).order, 1.0);
    const std::vector<double> scales = {0.12, 0.17};
    make_levels(pyramid, scales, {.eps = 0.1, .gated = gated});
    for (std::size_t s = 0; s < scales.size(); ++s) {
      const VoxelLevel& level = pyramid.levels[pyramid.level_of[s]];
      std::size_t near = 0;
      for (const Voxel& voxel : listed(level.voxels)) {
        near += (voxel.position - Vec3(0.5, 0.5, 0.5)).norm() < scales[s];
      }
      // 314 of a plane, thousands of points here
      EXPECT_LT(near, gated ? 700u : 300u) << "at scale " << s;
      EXPECT_GT(near, 100u);
    }
  }
}

}  // namespace
}  // namespace pcednet::gls
