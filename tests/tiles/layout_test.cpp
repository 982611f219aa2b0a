#include "pcednet/tiles/layout.h"

#include <gtest/gtest.h>

#include "pcednet/core/random.h"
#include "support/expect_error.h"

namespace pcednet::tiles {
namespace {

std::vector<Vec3> square_of_points(std::size_t points) {
  Random random(3);
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < points; ++i) {
    // Denser to the right.
    const double u = random.uniform();
    positions.emplace_back(100.0 * std::sqrt(u) + 1000.0, random.uniform(0.0, 100.0), 0.0);
  }
  return positions;
}

/// Points of the fullest core with its buffer, counted one by one.
std::uint64_t fullest(const std::vector<Vec3>& positions, const Grid& grid, double buffer,
                      const std::vector<Tile>& tiles) {
  std::uint64_t most = 0;
  for (const Tile& tile : tiles) {
    const double left = grid.edge(tile.column) - buffer, bottom = grid.edge(tile.row) - buffer;
    const double length = grid.length() + 2 * buffer;
    std::uint64_t count = 0;
    for (const Vec3& p : positions) {
      count += p.x() >= left && p.x() < left + length && p.y() >= bottom && p.y() < bottom + length;
    }
    most = std::max(most, count);
  }
  return most;
}

TEST(Layout, ChoosesTheLargestTilesThatFitTheMemory) {
  const std::vector<Vec3> positions = square_of_points(40000);
  const double cell = cell_length({{1000, 0, 0}, {1100, 100, 0}}, positions), buffer = 3.0;
  EXPECT_DOUBLE_EQ(cell, 0.2);
  CellCounts counts(cell);
  counts.add(positions);
  const std::uint64_t memory = memory_for(10000, {});
  const Grid grid = choose_grid(counts, cell, {buffer, memory});
  const auto tiles = lay_out(counts, grid, "", "{ID}.las");
  EXPECT_LE(fullest(positions, grid, buffer, tiles), 10000u);
  EXPECT_GT(fullest(positions, grid, buffer, tiles), 8000u);
  EXPECT_LE(memory_for(most_points(counts, grid, buffer), {}), memory);
  // With memory for all there is one tile, whatever its core begins at.
  EXPECT_EQ(
      lay_out(counts, choose_grid(counts, cell, {buffer, memory_for(40000, {})}), "", "{ID}.las")
          .size(),
      1u);
  // Normals that are made take memory.
  const detect::NormalsDecision made = {.made = true, .neighbours = 48};
  EXPECT_LT(choose_grid(counts, cell, {buffer, memory, made}).length(), grid.length());
  // Cores are never smaller than the buffer is wide.
  EXPECT_GE(choose_grid(counts, cell, {buffer, 1}).length(), buffer);
}

TEST(Layout, IsThatOfMostPointsWhereFewAreFarFromThem) {
  std::vector<Vec3> positions = square_of_points(40000);
  positions.push_back({-6e6, 4e5, 0.0});
  const double buffer = 3.0;
  const double cell = cell_length({{-6e6, 0, 0}, {1100, 4e5, 0}}, positions);
  EXPECT_LE(cell, 2.0);
  EXPECT_GE(cell, 0.2);
  CellCounts counts(cell);
  counts.add(positions);
  const Grid grid = choose_grid(counts, cell, {buffer, memory_for(10000, {})});
  const auto tiles = lay_out(counts, grid, "", "{ID}.las");
  EXPECT_LE(fullest(positions, grid, buffer, tiles), 10000u);
  EXPECT_GT(fullest(positions, grid, buffer, tiles), 8000u);
  EXPECT_EQ(most_points(counts, grid, buffer), fullest(positions, grid, buffer, tiles));
  EXPECT_EQ(cell_length({{0, 0, 0}, {1, 1, 0}}, std::vector<Vec3>(100, Vec3::Zero())), 1e-9);
}

TEST(Layout, CountsThePointsOfCoresWithTheirBuffers) {
  const std::vector<Vec3> positions = square_of_points(5000);
  const Grid grid{0.5, 40};
  const double buffer = 2.5;
  CellCounts counts(grid.cell);
  counts.add(positions);
  std::uint64_t sum = 0;
  for (const Tile& tile : lay_out(counts, grid, "", "{ID}.las")) {
    sum += fullest(positions, grid, buffer, {tile});
  }
  EXPECT_EQ(points_with_buffers(counts, grid, buffer), sum);
}

TEST(Layout, NamesTheTilesByTheirTemplate) {
  CellCounts counts(5.0);
  counts.add(std::vector<Vec3>{{1000, 0, 0}, {1010, -10, 0}, {1000, 3, 0}});
  const auto tiles =
      lay_out(counts, {5.0, 2}, "out", "t{ID}_{XLEFT}_{YBOTTOM}_{XRIGHT}_{YTOP}.laz");
  ASSERT_EQ(tiles.size(), 2u);
  EXPECT_EQ(tiles[0].output, "out/t0_1000_0_1010_10.laz");
  EXPECT_EQ(tiles[0].points, 2u);
  EXPECT_EQ(tiles[1].output, "out/t1_1010_-10_1020_0.laz");
  EXPECT_ERROR(ErrorKind::kUsage, lay_out(counts, {5.0, 2}, "out", "{ROW}0.xyz"));
  EXPECT_ERROR(ErrorKind::kUsage, lay_out(counts, {5.0, 2}, "out", "same.laz"));
  EXPECT_ERROR(ErrorKind::kUsage, lay_out(counts, {5.0, 2}, "out", "a/{ID}.laz"));
  EXPECT_ERROR(ErrorKind::kUsage, check_template("{ID}_{id}.laz"));
  EXPECT_ERROR(ErrorKind::kUsage, check_template("{ID.laz"));
}

}  // namespace
}  // namespace pcednet::tiles
