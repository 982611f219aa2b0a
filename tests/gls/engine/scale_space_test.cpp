#include "pcednet/gls/engine/scale_space.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gls/engine/fast_clouds.h"
#include "gls/variants.h"
#include "pcednet/core/error.h"
#include "support/expect_error.h"

namespace pcednet::gls {
namespace {

TEST(ScaleSpace, UsesTheEngineThatIsNamed) {
  const test::Cloud cube = test::cube(2000, 1);
  const auto targets = test::all_targets(2000);
  std::vector<float> out(2000 * 16 * 6);
  std::vector<FitStatus> status(2000 * 16);
  ScaleSpaceOptions options;
  ScaleSpace(cube.points(), options).describe(targets, out, status);
  EXPECT_EQ(out, test::describe(FastScaleSpace(cube.points(), options), targets).features);
  options.engine = Engine::kExact;
  const ScaleSpace exact(cube.points(), options);
  exact.describe(targets, out, status);
  EXPECT_EQ(out, test::describe<float>(cube, options).features);
  EXPECT_EQ(exact.order().size(), 2000u);
  options.engine = Engine::kFast;
  options.reconstruction = Reconstruction::kCovariancePlane;
  const ScaleSpace planes(cube.points(), options);
  EXPECT_EQ(planes.options().engine, Engine::kExact);
  planes.describe(targets, out, status);
  EXPECT_EQ(out, test::describe<float>(cube, options).features);
}

TEST(ScaleSpace, PutsTheFeaturesOfTheSecondGateAfterThoseOfTheFirst) {
  const test::Cloud cube = test::cube(2000, 1);
  const auto targets = test::all_targets(2000);
  ScaleSpaceOptions tight, loose, both;
  tight.side_gate = both.side_gate = 0.4;
  loose.side_gate = both.second_gate = -0.3;
  EXPECT_EQ(column_count(both), 12);
  EXPECT_EQ(column_names(both)[5], "phi");
  EXPECT_EQ(column_names(both)[6], "second_tau");
  std::vector<float> out(2000 * 16 * 12);
  std::vector<FitStatus> status(2000 * 16);
  ScaleSpace(cube.points(), both).describe(targets, out, status);
  const auto first = test::describe(FastScaleSpace(cube.points(), tight), targets);
  const auto second = test::describe(FastScaleSpace(cube.points(), loose), targets);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t cell = i / 12, column = i % 12;
    const auto& part = column < 6 ? first : second;
    ASSERT_EQ(out[i], part.features[cell * 6 + column % 6]) << i;
    ASSERT_EQ(status[cell], std::max(first.status[cell], second.status[cell])) << i;
  }
  both.second_gate = 1.5;
  EXPECT_ERROR(ErrorKind::kUsage, ScaleSpace(cube.points(), both));
  both.second_gate = 0.1;
  both.side_gate.reset();
  EXPECT_ERROR(ErrorKind::kUsage, ScaleSpace(cube.points(), both));
}

TEST(ScaleSpace, TakesAnOctaveAsIfMadeForIt) {
  const test::Cloud cube = test::cube(2000, 1);
  const auto targets = test::all_targets(2000);
  ScaleSpaceOptions options;
  options.range.s_min = 0.05, options.range.s_max = 0.8;
  options.range.s_max_ratio = 2.0;
  options.range.octaves = true;
  const auto described = [&](const ScaleSpace& space) {
    test::Matrix<float> matrix{16, 6, std::vector<float>(2000 * 16 * 6),
                               std::vector<FitStatus>(2000 * 16)};
    space.describe(targets, matrix.features, matrix.status);
    return matrix;
  };
  for (const Engine engine : {Engine::kFast, Engine::kExact}) {
    options.engine = engine;
    ScaleSpace space(cube.points(), options);
    ASSERT_EQ(octave_count(space.range()), kOctaves);
    const auto first = described(space);
    ScaleSpaceOptions its = options;
    its.range.s_min = 0.2, its.range.s_max = 0.4;
    space.take_octave(2);
    const ScaleSpace made(cube.points(), its);
    EXPECT_EQ(space.scales(), made.scales());
    test::expect_same_bits(described(space), described(made));
    space.take_octave(0);
    test::expect_same_bits(described(space), first);
    its.range.s_max_ratio = 0.0;  // one octave, of any extent
    ScaleSpace even(cube.points(), its);
    even.take_octave(0);
    EXPECT_EQ(even.scales(), made.scales());
  }
}

}  // namespace
}  // namespace pcednet::gls
