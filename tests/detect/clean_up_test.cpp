#include "pcednet/detect/clean_up.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"

namespace pcednet::detect {
namespace {

struct Grid {
  std::vector<Vec3> positions;
  Classification result;

  /// 20 x 20 points, a sharp band of two columns, one lone false edge, one point without a class.
  Grid() {
    for (int x = 0; x < 20; ++x) {
      for (int y = 0; y < 20; ++y) {
        positions.emplace_back(x + 0.01 * y, y, 0);
        const bool band = x == 9 || x == 10, lone = x == 3 && y == 7;
        result.p_sharp.push_back(band || lone ? 0.9f : 0.05f);
        result.p_smooth.push_back(0.03f);
        result.classes.push_back(band || lone ? kSharpEdge : kNonEdge);
      }
    }
    result.classes[15 * 20 + 4] = kUnlabelled;
  }
};

TEST(CleanUp, RemovesLoneEdgesAndKeepsBands) {
  Grid grid;
  clean_up(grid.positions, grid.result);
  EXPECT_EQ(grid.result.classes[3 * 20 + 7], kNonEdge);
  EXPECT_EQ(grid.result.classes[15 * 20 + 4], kUnlabelled);
  for (int y = 0; y < 20; ++y) EXPECT_EQ(grid.result.classes[9 * 20 + y], kSharpEdge) << y;
  EXPECT_EQ(grid.result.counts.sharp, 40u);
  EXPECT_EQ(grid.result.counts.unlabelled, 1u);
}

TEST(CleanUp, MixesProbabilitiesAsItSays) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}};
  Classification result;
  result.classes = {kSharpEdge, kNonEdge, kNonEdge};
  result.p_sharp = {0.9f, 0.1f, 0.2f};
  result.p_smooth = {0.0f, 0.0f, 0.0f};
  clean_up(positions, result, {.neighbours = 1, .weight = 0.25});
  EXPECT_NEAR(result.p_sharp[0], (0.9 + 0.25 * 0.1) / 1.25, 1e-6);
  EXPECT_NEAR(result.p_sharp[2], (0.2 + 0.25 * 0.1) / 1.25, 1e-6);
}

TEST(CleanUp, IsTheSameForAnyThreadsAndOrder) {
  Grid grid, reversed;
  set_thread_count(1);
  clean_up(grid.positions, grid.result);
  set_thread_count(8);
  for (auto* list : {&reversed.result.p_sharp, &reversed.result.p_smooth})
    std::reverse(list->begin(), list->end());
  std::reverse(reversed.result.classes.begin(), reversed.result.classes.end());
  std::reverse(reversed.positions.begin(), reversed.positions.end());
  clean_up(reversed.positions, reversed.result);
  set_thread_count(0);
  std::reverse(reversed.result.p_sharp.begin(), reversed.result.p_sharp.end());
  EXPECT_EQ(grid.result.p_sharp, reversed.result.p_sharp);
}

TEST(CleanUp, RefusesSizesThatDiffer) {
  Grid grid;
  grid.positions.pop_back();
  EXPECT_THROW(clean_up(grid.positions, grid.result), Error);
}

}  // namespace
}  // namespace pcednet::detect
