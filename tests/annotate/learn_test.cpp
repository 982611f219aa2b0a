#include "workbench/annotate/learn/learn.h"

#include <gtest/gtest.h>

#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/nn/predict.h"
#include "support/expect_error.h"

namespace pcednet::annotate {
namespace {

TEST(Learn, WithTwoOfThreeClassesKeepsTheirOdds) {
  auto three = detect::load_model(PCEDNET_SOURCE_DIR "/models/scan.safetensors");
  three.context.reset();
  const auto two = with_classes(three, 2);
  Random random(1);
  std::vector<float> samples(50 * 96);
  for (float& x : samples) x = static_cast<float>(random.uniform(-1, 1));
  const auto p3 = nn::predict(three.network, samples);
  const auto p2 = nn::predict(two.network, samples);
  for (std::size_t i = 0; i < 50; ++i) {
    // Softmax without an output: the others keep their ratio.
    const double expected = p3[3 * i + 2] / (p3[3 * i] + p3[3 * i + 2]);
    EXPECT_NEAR(p2[3 * i + 2], expected, 1e-5);
    EXPECT_LT(p2[3 * i + 1], 1e-30);
  }
}

TEST(Learn, LeavesSmoothEdgeOutAsLongAsNoneIsPainted) {
  const std::vector<std::uint8_t> sharp = {0, 2, 255}, all = {0, 1, 2}, rest = {1, 2},
                                  none = {0, 1};
  EXPECT_EQ(classes_to_learn(sharp, {.classes = 3}), 2);
  EXPECT_EQ(classes_to_learn(all, {.classes = 3}), 3);
  EXPECT_EQ(classes_to_learn(all, {.classes = 2}), 2);
  EXPECT_EQ(classes_to_learn(rest, {.classes = 2}), 2);
  EXPECT_ERROR(ErrorKind::kInsufficient, classes_to_learn(rest, {.classes = 3}));
  EXPECT_ERROR(ErrorKind::kInsufficient, classes_to_learn(none, {.classes = 2}));
}

TEST(Learn, TellsWhichEpochsAreTheContextNetworks) {
  Start start{.model = detect::load_model(PCEDNET_SOURCE_DIR "/models/scan.safetensors")};
  EXPECT_EQ(epochs_of(&start), 2 * kAdaptEpochs);
  EXPECT_EQ(context_epochs_of(&start), kAdaptEpochs);
  start.model.context.reset();
  EXPECT_EQ(epochs_of(&start), kAdaptEpochs);
  EXPECT_EQ(context_epochs_of(&start), 0);
  EXPECT_EQ(context_epochs_of(nullptr), 0);
}

}  // namespace
}  // namespace pcednet::annotate
