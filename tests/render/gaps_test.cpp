#include "workbench/render/splat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace pcednet::render {
namespace {

constexpr int kSide = 60;
constexpr int kMiddle = kSide / 2;
constexpr int kGap = 8;
constexpr Rgb kColour = {10, 20, 30};

/// A plane of slope `slope` (depth per pixel) before a far background, open where `is_open` says.
Layer plane(float slope, const std::function<bool(int, int)>& is_open) {
  Layer layer{kSide, kSide, {}, {}, 0.1f, 4.0f};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool open = is_open(x, y);
      layer.depth.push_back(open ? kNoDepth : 10.0f + slope * static_cast<float>(x));
      layer.colour.push_back(open ? Rgb{} : kColour);
    }
  }
  return layer;
}

int open_pixels(const Layer& layer) {
  return static_cast<int>(std::count(layer.depth.begin(), layer.depth.end(), kNoDepth));
}

bool in_disc(int x, int y, double diameter) {
  return std::hypot(x - kMiddle, y - kMiddle) < 0.5 * diameter;
}

TEST(Gaps, AreClosedInAPlaneAtAnySlant) {
  for (const float slope : {0.0f, 0.1f, -1.0f}) {
    Layer layer = plane(slope, [](int x, int y) { return in_disc(x, y, kGap); });
    ASSERT_GT(open_pixels(layer), 30);
    close_gaps(layer, kGap);
    EXPECT_EQ(open_pixels(layer), 0) << slope;
    const std::size_t pixel = kMiddle * kSide + kMiddle;
    EXPECT_FLOAT_EQ(layer.depth[pixel], 10.0f + slope * kMiddle);
    EXPECT_EQ(layer.colour[pixel], kColour);
  }
}

TEST(Gaps, LeaveOpeningsSlitsAndSurroundingsOpen) {
  const auto stays = [](const std::function<bool(int, int)>& is_open) {
    Layer layer = plane(0.0f, is_open);
    const std::vector<float> before = layer.depth;
    close_gaps(layer, kGap);
    return layer.depth == before;
  };
  EXPECT_TRUE(stays([](int x, int) { return std::abs(x - kMiddle) < 2; }));
  EXPECT_TRUE(stays([](int x, int) { return x > kMiddle; }));
  EXPECT_TRUE(stays([](int x, int y) { return x > kMiddle && y > kMiddle; }));
  EXPECT_TRUE(stays([](int x, int y) { return !in_disc(x, y, 20.0); }));

  Layer wide = plane(0.0f, [](int x, int y) { return in_disc(x, y, 4 * kGap); });
  close_gaps(wide, kGap);
  EXPECT_EQ(wide.depth[kMiddle * kSide + kMiddle], kNoDepth);
}

TEST(Gaps, LeaveShallowDentsAlone) {
  Layer layer = plane(0.0f, [](int, int) { return false; });
  const std::size_t pixel = kMiddle * kSide + kMiddle;
  layer.depth[pixel] += layer.grain;
  const std::vector<float> before = layer.depth;
  close_gaps(layer, kGap);
  EXPECT_EQ(layer.depth, before);
}

TEST(Gaps, AreFewInAPictureSmallerThanThey) {
  Layer layer = plane(0.0f, [](int, int) { return true; });
  close_gaps(layer, kSide);
  EXPECT_EQ(open_pixels(layer), kSide * kSide);
}

}  // namespace
}  // namespace pcednet::render
