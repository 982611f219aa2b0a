#include "pcednet/gls/engine/voxel_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "gls/engine/listed_voxels.h"
#include "gls/test_clouds.h"
#include "pcednet/core/random.h"
#include "pcednet/gls/oriented_points.h"

namespace pcednet::gls {
namespace {

/// Sums over all points of a level about one place: what merging must conserve.
struct Totals {
  double count = 0.0, pp = 0.0, pn = 0.0;
  Vec3 p = Vec3::Zero(), n = Vec3::Zero();

  explicit Totals(VoxelSpan voxels, const Vec3& place) {
    for (const Voxel& v : listed(voxels)) {
      const Vec3 y = v.position - place, normal(v.normal[0], v.normal[1], v.normal[2]);
      count += v.count;
      p += v.count * y;
      n += v.count * normal;
      pp += v.count * (y.squaredNorm() + v.qq);
      pn += v.count * (y.dot(normal) + v.qn);
    }
  }
};

VoxelPyramid pyramid_of(const test::Cloud& cloud, const std::vector<double>& scales,
                        double eps = 0.2) {
  const auto order = point_order(cloud.points()).order;
  VoxelPyramid pyramid = make_pyramid(cloud.positions, cloud.normals, order, 1.0);
  make_levels(pyramid, scales, {.eps = eps});
  return pyramid;
}

const std::vector<double> kScales = {0.05, 0.1, 0.2, 0.4, 0.8, 1.6};

TEST(VoxelPyramid, ConservesCountsMeansAndSecondMoments) {
  for (const auto& cloud : {test::cube(20000, 1, 0.01, 0.2), test::sphere(20000, 2)}) {
    const VoxelPyramid pyramid = pyramid_of(cloud, kScales);
    ASSERT_GE(pyramid.levels.size(), 4u);
    const Vec3 place(0.1, 0.2, -0.3);
    const Totals points(pyramid.levels.front().voxels, place);
    for (const VoxelLevel& level : pyramid.levels) {
      const Totals totals(level.voxels, place);
      EXPECT_EQ(totals.count, points.count);
      // Floats of 6e-8 each, rounded independently.
      EXPECT_NEAR((totals.p - points.p).norm() / points.count, 0.0, 1e-13);
      EXPECT_NEAR((totals.n - points.n).norm() / points.count, 0.0, 1e-7);
      EXPECT_NEAR(totals.pp / points.pp, 1.0, 1e-8);
      EXPECT_NEAR((totals.pn - points.pn) / points.count, 0.0, 1e-7);
    }
  }
}

TEST(VoxelPyramid, MergesWithinACellAndAnAxisOnly) {
  const test::Cloud cloud = test::cube(20000, 1, 0.01, 0.2);
  const VoxelPyramid pyramid = pyramid_of(cloud, kScales);
  for (std::size_t l = 1; l < pyramid.levels.size(); ++l) {
    const VoxelLevel& level = pyramid.levels[l];
    std::map<std::array<int, 4>, int> seen;
    for (const Voxel& v : listed(level.voxels)) {
      EXPECT_LE(v.qq, 3 * level.cell * level.cell);
      const Vec3 cell = ((v.position - pyramid.origin) / level.cell).array().floor();
      int axis = 0;
      for (int a = 1; a < 3; ++a) {
        if (std::abs(v.normal[static_cast<std::size_t>(a)]) >
            std::abs(v.normal[static_cast<std::size_t>(axis)])) {
          axis = a;
        }
      }
      const int sign = v.normal[static_cast<std::size_t>(axis)] < 0 ? -1 : 1;
      ++seen[{int(cell.x()), int(cell.y()), int(cell.z()), (axis + 1) * sign}];
    }
    // A mean normal's axis is its members' but for the rare mean of oblique ones.
    std::size_t twice = 0;
    for (const auto& [key, count] : seen) twice += count > 1;
    EXPECT_LE(twice, level.voxels.size() / 50);
  }
}

TEST(VoxelPyramid, ServesEachScaleFromSmallEnoughVoxels) {
  const test::Cloud cloud = test::scene(20000, 3);
  const VoxelPyramid pyramid = pyramid_of(cloud, kScales);
  ASSERT_EQ(pyramid.level_of.size(), kScales.size());
  std::size_t total = 0;
  for (const VoxelLevel& level : pyramid.levels) total += level.voxels.size();
  EXPECT_LE(total, 3 * cloud.positions.size());
  for (std::size_t s = 0; s < kScales.size(); ++s) {
    EXPECT_LE(pyramid.levels[pyramid.level_of[s]].cell, 0.2 * kScales[s] * (1 + 1e-15));
  }
}

TEST(VoxelPyramid, FlipsWithTheNormals) {
  test::Cloud cloud = test::cube(5000, 1, 0.02, 0.5);
  const VoxelPyramid before = pyramid_of(cloud, kScales);
  for (Vec3& n : cloud.normals) n = -n;
  const VoxelPyramid after = pyramid_of(cloud, kScales);
  ASSERT_EQ(before.levels.size(), after.levels.size());
  for (std::size_t l = 0; l < before.levels.size(); ++l) {
    ASSERT_EQ(before.levels[l].voxels.size(), after.levels[l].voxels.size());
    for (std::size_t i = 0; i < before.levels[l].voxels.size(); ++i) {
      const Voxel a = before.levels[l].voxels[i], b = after.levels[l].voxels[i];
      ASSERT_EQ(a.position, b.position);
      ASSERT_EQ(a.qq, b.qq);
      ASSERT_EQ(a.qn, -b.qn);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(a.normal[k], -b.normal[k]);
    }
  }
}

TEST(VoxelPyramid, KeepsCellsApartThatAreTooManyForTheKeys) {
  // Cells 2^20 apart share a key; the clumps must not be merged into one voxel.
  test::Cloud cloud;
  for (int i = 0; i < 2000; ++i) {
    const double far = i % 2 ? 0x1p20 : 0.0;
    cloud.add(Vec3(far + 1e-3 * i / 2000, 0, 0), Vec3::UnitZ());
  }
  const VoxelPyramid pyramid = pyramid_of(cloud, {5.0});
  ASSERT_EQ(pyramid.levels.size(), 2u);
  for (const Voxel& v : listed(pyramid.levels[1].voxels)) EXPECT_LT(v.qq, 1.0f);
}

TEST(VoxelPyramid, FollowsTheCurveWhereCellsAreTooManyForTheKeys) {
  // Clumps 2^20 cells apart, whose cells have the same keys: each is one stretch of the level.
  constexpr double kFar = 10.0 * 0x1p20;
  test::Cloud cloud;
  Random random(7);
  for (int i = 0; i < 4000; ++i) {
    const double x = 50.0 * random.uniform();
    const double y = 50.0 * random.uniform();
    cloud.add(Vec3(x + (i % 2 ? kFar : 0.0), y, 0), Vec3::UnitZ());
  }
  const VoxelPyramid pyramid = pyramid_of(cloud, {50.0});
  ASSERT_EQ(pyramid.levels.size(), 2u);
  int changes = 0;
  const auto& voxels = pyramid.levels[1].voxels;
  const auto is_far = [&](std::size_t i) { return voxels[i].position.x() > 0.5 * kFar; };
  for (std::size_t i = 1; i < voxels.size(); ++i) changes += is_far(i) != is_far(i - 1);
  EXPECT_EQ(changes, 1);
}

TEST(VoxelPyramid, MergesClumpsBehindTheRangesOfTheForecast) {
  // The last points of the curve, near (1, 1); a cell of 1e-3 holds hardly two others.
  for (const int clumped : {0, 20000}) {
    test::Cloud cloud;
    Random random(8);
    for (int i = 0; i < 40000; ++i) {
      const bool in_clump = i < clumped;
      const double x = random.uniform(), y = random.uniform();
      cloud.add(in_clump ? Vec3(0.99 + 1e-5 * x, 0.99 + 1e-5 * y, 0) : Vec3(x, y, 0),
                Vec3::UnitZ());
    }
    const VoxelPyramid pyramid = pyramid_of(cloud, {5e-3});
    ASSERT_EQ(pyramid.levels.size(), clumped ? 2u : 1u);
    if (clumped) EXPECT_LT(pyramid.levels[1].voxels.size(), 20010u);
  }
}

TEST(VoxelPyramid, LeavesOutPointsWithoutNormal) {
  test::Cloud cloud = test::cube(4000, 1);
  for (std::size_t i = 0; i < 4000; i += 2) cloud.normals[i] = Vec3::Zero();
  const VoxelPyramid pyramid = pyramid_of(cloud, kScales);
  for (const VoxelLevel& level : pyramid.levels) {
    double count = 0;
    for (const Voxel& v : listed(level.voxels)) count += v.count;
    EXPECT_EQ(count, 2000);
  }
}

TEST(VoxelPyramid, OfAPartHasTheVoxelsOfTheWholeAwayFromItsRim) {
  const test::Cloud cloud = test::cube(40000, 3, 0.01, 0.2);
  const std::vector<double> scales = {0.03, 0.06, 0.12, 0.24};
  const VoxelPyramid whole = pyramid_of(cloud, scales);
  test::Cloud part;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (cloud.positions[i].x() > -0.1) part.add(cloud.positions[i], cloud.normals[i]);
  }
  const PyramidPlan plan = {whole.origin, whole.side, whole.plan};
  VoxelPyramid pyramid =
      make_pyramid(part.positions, part.normals, point_order(part.points()).order, 1.0, &plan);
  make_levels(pyramid, scales, {.eps = 0.2, .whole = &plan});
  ASSERT_EQ(pyramid.level_of, whole.level_of);
  using Key = std::array<float, 3>;
  for (std::size_t l = 1; l < pyramid.levels.size(); ++l) {
    // Blocks of 8 cells are merged together or not.
    const double inside = -0.1 + 10.0 * whole.levels[l].cell;
    std::map<Key, float> expected, found;
    const auto list = [&](const VoxelLevel& level, std::map<Key, float>& to) {
      for (const Voxel& v : listed(level.voxels)) {
        const Vec3& p = v.position;
        // To float: sums in another order.
        const Key key = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z())};
        if (p.x() > inside) to[key] = v.count;
      }
    };
    list(whole.levels[l], expected);
    list(pyramid.levels[l], found);
    std::size_t same = 0;
    for (const auto& [key, count] : expected) {
      const auto at = found.find(key);
      same += at != found.end() && at->second == count;
    }
    EXPECT_EQ(found.size(), expected.size());
    // A coordinate may round to the float beside.
    EXPECT_GE(static_cast<double>(same), 0.999 * static_cast<double>(expected.size()));
    EXPECT_GT(expected.size(), 0u);
  }
}

}  // namespace
}  // namespace pcednet::gls
