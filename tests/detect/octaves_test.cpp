#include "pcednet/detect/octaves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include "pcednet/detect/describe.h"
#include "pcednet/detect/part_of_cloud.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

/// A plane with a spacing of 1 on the left, and as many points with one of `wide` on the right.
PointCloud two_spacings(int wide) {
  PointCloud cloud;
  for (int x = -20; x <= 20 * wide * wide; x += x < 0 ? 1 : wide) {
    for (int y = 0; y < 80; y += x < 0 ? 1 : wide) cloud.positions.emplace_back(x, y, 0.0);
  }
  cloud.normals.assign(cloud.size(), Vec3::UnitZ());
  return cloud;
}

gls::ScaleSpaceOptions with_octaves() {
  gls::ScaleSpaceOptions options;
  options.scales = 4;
  options.range.s_max_ratio = 8.0;
  options.range.octaves = true;
  return options;
}

TEST(Octaves, AreTheSpacingInPowersOfTwo) {
  PointCloud cloud = two_spacings(4);
  cloud.positions.push_back(cloud.positions.back());  // a copy
  cloud.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  const auto curve = spatial::curve_order(cloud.positions);
  const auto octaves_from = [&](double s_min, double s_max) {
    return octaves_of(cloud.positions, curve,
                      {.s_min = s_min, .s_max = s_max, .s_max_ratio = 8.0, .octaves = true});
  };
  const auto octaves = octaves_from(1.2, 8.0 * 9.6);
  ASSERT_EQ(octaves.size(), cloud.positions.size());
  for (std::size_t i = 0; i + 2 < octaves.size(); ++i) {
    const double x = cloud.positions[i].x();
    if (x > -6.0 && x < 8.0) continue;
    ASSERT_EQ(octaves[i], x < 0.0 ? 0 : 2) << cloud.positions[i];
  }
  EXPECT_EQ(octaves[octaves.size() - 2], octaves[octaves.size() - 3]);
  EXPECT_EQ(octaves.back(), 0);
  EXPECT_EQ(octaves_from(0.01, 0.64).front(), gls::kOctaves - 1);
  EXPECT_EQ(octaves_from(0.01, 0.3).front(), 1);
  EXPECT_EQ(octaves_from(0.01, 0.08).front(), 0);
}

TEST(Octaves, HaveEveryPointOnceAtScalesOfItsOwn) {
  const PointCloud cloud = two_spacings(4);
  const PreparedCloud prepared = prepare(cloud);
  std::multiset<std::uint32_t> seen;
  std::vector<double> smallest;
  for_each_octave(prepared, with_octaves(), nullptr, [&](const auto& space, const auto& points) {
    seen.insert(points.begin(), points.end());
    smallest.push_back(space.scales().front());
    if (smallest.size() > 1) {
      EXPECT_NEAR(space.scales().back(), 8.0 * smallest.back(), 1e-9);
    }
  });
  EXPECT_EQ(seen.size(), cloud.size());
  EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), cloud.size());
  ASSERT_GE(smallest.size(), 2u);
  EXPECT_DOUBLE_EQ(smallest[1], 2.0 * smallest[0]);
}

TEST(Octaves, OfAnEvenCloudAreOne) {
  PointCloud cloud;
  for (int i = 0; i < 2500; ++i) cloud.positions.emplace_back(i % 50, i / 50, 0.01 * (i % 7));
  cloud.normals.assign(cloud.size(), Vec3::UnitZ());
  const PreparedCloud prepared = prepare(cloud);
  gls::ScaleSpaceOptions plain = with_octaves();
  plain.range.octaves = false;
  const auto described = describe(prepared, with_octaves());
  EXPECT_EQ(described.values, describe(prepared, plain).values);
  EXPECT_EQ(described.order, prepared.curve);
}

TEST(Octaves, DescribeEachPointInItsOwnSpace) {
  const PointCloud cloud = two_spacings(4);
  const PreparedCloud prepared = prepare(cloud);
  const gls::ScaleSpaceOptions options = with_octaves();
  const auto described = describe(prepared, options);
  const gls::ScaleSpace whole({cloud.positions, cloud.normals, prepared.curve}, options);
  const gls::ScaleRange range = whole.range();
  ASSERT_EQ(gls::octave_count(range), gls::kOctaves);
  const auto octaves = octaves_of(cloud.positions, prepared.curve, range);
  const std::size_t width = row_width(options);
  for (std::size_t octave = 0; octave < gls::kOctaves; ++octave) {
    gls::ScaleSpaceOptions its = options;
    if (octave > 0) {
      its.range.s_min = gls::at_octave(range, octave).s_min;
      its.range.s_max = gls::at_octave(range, octave).s_max;
    }
    const gls::ScaleSpace space({cloud.positions, cloud.normals, prepared.curve}, its);
    for (std::size_t row = 0; row < described.order.size(); row += 17) {
      const std::uint32_t point = described.order[row];
      if (octaves[point] != octave) continue;
      std::vector<float> expected(width);
      describe(space, std::span(&point, 1), expected);
      const auto begin = described.values.begin() + static_cast<std::ptrdiff_t>(row * width);
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), begin)) << point;
    }
  }
}

}  // namespace
}  // namespace pcednet::detect
