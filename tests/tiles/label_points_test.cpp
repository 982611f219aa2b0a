#include "pcednet/tiles/label_points.h"

#include <gtest/gtest.h>

#include "pcednet/core/random.h"
#include "pcednet/detect/decide.h"
#include "pcednet/formats/write_cloud.h"
#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/layout.h"
#include "pcednet/tiles/sort_inputs.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

class LabelPoints : public testing::Test, protected test::OwnFolder {
 protected:
  /// A plan of two inputs whose points are in no order.
  Plan plan_of(const std::vector<Vec3>& positions) const {
    Plan plan;
    std::vector<std::string> notes;
    CellCounts counts(1.0);
    for (const std::size_t half : {std::size_t{0}, positions.size() / 2}) {
      PointCloud cloud;
      cloud.positions.assign(
          positions.begin() + static_cast<std::ptrdiff_t>(half),
          positions.begin() + static_cast<std::ptrdiff_t>(half + positions.size() / 2));
      set_attribute(cloud, make_attribute("kept", std::vector<float>(cloud.size(), 7.0f)));
      const fs::path path = folder_ / (std::to_string(half) + ".ply");
      formats::write_cloud(path, cloud, {});
      const auto count = [&](const PointCloud& part) { counts.add(part.positions); };
      plan.inputs.push_back(index_input(path, nullptr, notes, count).input);
    }
    plan.box = bounding_box(positions);
    plan.grid = {1.0, 1};
    plan.tiles = lay_out(counts, plan.grid, folder_, "{ID}.ply");
    return plan;
  }

  static void check_numbers(const Plan& plan, const std::vector<Vec3>& positions) {
    std::vector<int> seen(positions.size());
    for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
      const TileCloud tile = read_tile(plan, id);
      ASSERT_EQ(tile.numbers.size(), tile.core.size());
      ASSERT_EQ(tile.core.attributes.size(), 1u);
      EXPECT_EQ(tile.core.attributes[0].name, "kept");
      for (std::size_t i = 0; i < tile.core.size(); ++i) {
        ++seen[tile.numbers[i]];
        const Vec3& position = positions[tile.numbers[i]];
        if (position.allFinite()) {
          ASSERT_EQ(tile.core.positions[i], position);
        }
      }
    }
    EXPECT_EQ(seen, std::vector<int>(positions.size(), 1));
  }
};

TEST_F(LabelPoints, PointsKeepTheirNumbersThroughTilesAndSorting) {
  Random random(5);
  std::vector<Vec3> positions;
  for (int i = 0; i < 120'000; ++i) {
    const auto at = [&] { return static_cast<double>(static_cast<float>(random.uniform(-2, 2))); };
    const double x = at(), y = at();
    positions.emplace_back(x, y, 0.0);
    if (i % 10'000 == 3) positions.back().x() = NAN;
  }
  Plan plan = plan_of(positions);
  ASSERT_EQ(plan.tiles.size(), 16u);
  ASSERT_GT(plan.inputs[0].chunks.size(), 1u);
  check_numbers(plan, positions);
  sort_inputs({.folder = folder_ / "sorted", .numbered = true}, plan, nullptr);
  ASSERT_EQ(plan.inputs.size(), plan.tiles.size());
  check_numbers(plan, positions);
}

TEST_F(LabelPoints, SortingThatStopsLeavesNothing) {
  Random random(6);
  std::vector<Vec3> positions;
  for (int i = 0; i < 20'000; ++i) {
    const double y = random.uniform(-2, 2), x = random.uniform(-2, 2);
    positions.emplace_back(x, y, 0.0);
  }
  Plan plan = plan_of(positions);
  int asked = 0, stop_at = 0;  // counts until nothing is left to stop
  const Progress progress{.report = {}, .cancelled = [&] { return ++asked > stop_at; }};
  const fs::path folder = folder_ / "sorted";
  while (asked >= stop_at) {
    stop_at += 5, asked = 0;
    try {
      sort_inputs({.folder = folder}, plan, &progress);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
      EXPECT_TRUE(fs::is_empty(folder)) << "after " << stop_at;
    }
  }
  EXPECT_GT(stop_at, 5);
  EXPECT_EQ(static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {})),
            plan.tiles.size());
}

TEST_F(LabelPoints, FindingsComeBackInOrder) {
  for (const bool normals : {false, true}) {
    const bool own_classes = !normals;
    PointLabels labels(folder_ / "out.ply", own_classes, normals);
    // Three tiles that share out the numbers 0 to 999.
    for (std::size_t tile = 0; tile < 3; ++tile) {
      std::vector<std::uint64_t> numbers;
      for (std::uint64_t i = 1000; i-- > 0;) {
        if (i / 10 % 3 == tile) numbers.push_back(i);
      }
      TileFindings some{.found = detect::nothing_found(numbers.size(), own_classes)};
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        const auto number = static_cast<float>(numbers[k]);
        some.found.classes[k] = static_cast<std::uint8_t>(numbers[k] % 4);
        some.found.p_sharp[k] = 1.0f / (1.0f + number);
        some.found.p_smooth[k] = number;
        if (own_classes) some.found.p_class[k] = 0.5f * number;
        if (normals) some.made.emplace_back(0.1 * number, 1.0 / 3.0, -number);
      }
      labels.put(numbers, some);
    }
    const TileFindings back = labels.get(100, 1000);
    ASSERT_EQ(back.found.classes.size(), 900u);
    EXPECT_EQ(back.made.size(), normals ? 900u : 0u);
    EXPECT_EQ(back.found.p_class.size(), own_classes ? 900u : 0u);
    EXPECT_EQ(back.found.counts.sharp, 225u);
    for (std::size_t i = 0; i < 900; ++i) {
      const auto number = static_cast<float>(i + 100);
      EXPECT_EQ(back.found.classes[i], (i + 100) % 4);
      EXPECT_EQ(back.found.p_sharp[i], 1.0f / (1.0f + number));
      EXPECT_EQ(back.found.p_smooth[i], number);
      if (own_classes) {
        EXPECT_EQ(back.found.p_class[i], 0.5f * number);
      }
      if (!normals) continue;
      EXPECT_EQ(back.made[i], Vec3(0.1 * number, 1.0 / 3.0, -number));
    }
  }
}

}  // namespace
}  // namespace pcednet::tiles
