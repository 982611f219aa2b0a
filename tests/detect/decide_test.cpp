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

TEST(Decide, OfOwnClassesTheMostProbable) {
  EdgeModel model;
  model.table = parse_classes("ground,wall,pipe,tree");
  model.classes = {0, 2, 3};
  Classification found = nothing_found(3, true);
  decide(std::vector<std::uint32_t>{0, 2}, std::vector<float>{0.3f, 0.45f, 0.25f, 0.2f, 0.2f, 0.6f},
         model, found);
  EXPECT_EQ(found.classes, (std::vector<std::uint8_t>{2, kUnlabelled, 3}));
  EXPECT_EQ(found.p_class, (std::vector<float>{0.45f, 0.0f, 0.6f}));
  EXPECT_EQ(found.p_sharp, (std::vector<float>(3, 0.0f)));
}

TEST(Decide, EdgesTogetherAgainstAnOwnClass) {
  EdgeModel model;
  model.table = parse_classes("edges,pipe");
  model.classes = {kNonEdge, kSmoothEdge, kSharpEdge, 4};
  Classification found = nothing_found(3, true);
  decide(
      std::vector<std::uint32_t>{0, 1, 2},
      std::vector<float>{0.1f, 0.25f, 0.3f, 0.35f,   // an edge, of no kind more probable than pipe
                         0.2f, 0.05f, 0.1f, 0.65f,   //
                         0.5f, 0.1f, 0.05f, 0.35f},  //
      model, found);
  EXPECT_EQ(found.classes, (std::vector<std::uint8_t>{kSharpEdge, 4, kNonEdge}));
  EXPECT_EQ(found.p_class, (std::vector<float>{0.3f, 0.65f, 0.5f}));
  EXPECT_EQ(found.p_sharp, (std::vector<float>{0.3f, 0.1f, 0.05f}));
}

}  // namespace
}  // namespace pcednet::detect
