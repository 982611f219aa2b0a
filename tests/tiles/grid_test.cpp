#include "pcednet/tiles/grid.h"

#include <gtest/gtest.h>

#include <map>

#include "pcednet/core/random.h"
#include "pcednet/tiles/layout.h"

namespace pcednet::tiles {
namespace {

TEST(Grid, PutsTheLowerEdgeIntoTheCoreAndTheUpperIntoTheNext) {
  const Grid grid{0.5, 4};
  const auto core_of = [&](double x) { return grid.core_of({x, -x, 7.0})[0]; };
  EXPECT_EQ(core_of(0.0), 0);
  EXPECT_EQ(core_of(std::nextafter(2.0, 0.0)), 0);
  EXPECT_EQ(core_of(2.0), 1);
  EXPECT_EQ(core_of(-2.0), -1);
  EXPECT_EQ(core_of(std::nextafter(-2.0, -3.0)), -2);
  EXPECT_EQ(grid.core_of({0.0, -0.25, 0.0}), (std::array<std::int64_t, 2>{0, -1}));
  EXPECT_EQ(grid.edge(-2), -4.0);
}

TEST(Grid, CountsThePointsOfEachCoreAsItAsksForThem) {
  // Cells whose length is no binary number, points on their edges among others.
  const Grid grid{0.1, 7};
  Random random(5);
  std::vector<Vec3> positions;
  for (int i = 0; i < 20000; ++i) {
    const double y = random.uniform(-30, 30), x = random.uniform(-30, 30);
    positions.emplace_back(x, y, 0.0);
    positions.emplace_back(0.1 * static_cast<double>(i % 600 - 300), 0.7 * (i % 90 - 45), 0.0);
  }
  positions.push_back(Vec3::Constant(NAN));
  CellCounts counts(grid.cell);
  counts.add(positions);
  std::map<std::array<std::int64_t, 2>, std::size_t> expected;
  for (const Vec3& position : positions) {
    if (position.allFinite()) ++expected[grid.core_of(position)];
  }
  ++expected.begin()->second;  // the one that is not finite
  const std::vector<Tile> tiles = lay_out(counts, grid, "folder", "{ID}.las");
  ASSERT_EQ(tiles.size(), expected.size());
  for (const Tile& tile : tiles) {
    EXPECT_EQ(tile.points, (expected[{tile.column, tile.row}]));
  }
}

}  // namespace
}  // namespace pcednet::tiles
