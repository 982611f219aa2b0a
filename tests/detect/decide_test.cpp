#include "pcednet/detect/decide.h"

#include <gtest/gtest.h>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::detect {
namespace {

TEST(Decide, AnEdgeWhereItsKindsTogetherAreProbable) {
  const std::vector<std::uint32_t> points = {0, 1, 2, 4};
  const std::vector<float> probabilities = {
      0.45f, 0.30f, 0.25f,  // non-edge is the most probable class, but an edge more probable
      0.55f, 0.05f, 0.40f, 0.10f, 0.30f, 0.60f, 0.40f, 0.30f, 0.30f};
  Classification found = nothing_found(5);
  decide(points, probabilities, {kNonEdge, kSmoothEdge, kSharpEdge}, found);
  EXPECT_EQ(found.classes, (std::vector<std::uint8_t>{kSmoothEdge, kNonEdge, kSharpEdge,
                                                      kUnlabelled, kSharpEdge}));
  EXPECT_FLOAT_EQ(found.p_sharp[0], 0.25f);
  EXPECT_FLOAT_EQ(found.p_smooth[0], 0.30f);
  EXPECT_FLOAT_EQ(found.p_sharp[3], 0.0f);
}

TEST(Decide, OfTwoClassesTheMoreProbable) {
  Classification found = nothing_found(2);
  decide(std::vector<std::uint32_t>{0, 1}, std::vector<float>{0.4f, 0.6f, 0.6f, 0.4f},
         {kNonEdge, kSharpEdge}, found);
  EXPECT_EQ(found.classes, (std::vector<std::uint8_t>{kSharpEdge, kNonEdge}));
}

}  // namespace
}  // namespace pcednet::detect
