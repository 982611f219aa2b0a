#include "pcednet/nn/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pcednet/core/error.h"
#include "pcednet/nn/network.h"
#include "support/expect_error.h"

namespace pcednet::nn {
namespace {

TEST(Architecture, HasTheWeightsOfThePaper) {
  EXPECT_EQ(weight_count({}), 1623u);
  EXPECT_EQ(weight_count({.classes = 2}), 1606u);
  EXPECT_EQ(weight_count({.kind = NetworkKind::kFc}), 6663u);
  EXPECT_EQ(weight_count({.kind = NetworkKind::kCnn}), 9723u);
}

TEST(Architecture, AddsOnePairwiseLayerPerDoublingOfTheScales) {
  const auto tree_layers = [](int scales) {
    int count = 0;
    for (const Layer& layer : make_plan({.scales = scales}).layers) {
      count += layer.name.starts_with("tree.");
    }
    return count;
  };
  EXPECT_EQ(tree_layers(4), 1);
  EXPECT_EQ(tree_layers(8), 2);
  EXPECT_EQ(tree_layers(16), 3);
  EXPECT_EQ(tree_layers(32), 4);
  EXPECT_EQ(tree_layers(128), 6);
}

TEST(Architecture, WiderNetworksCountTheirWeights) {
  EXPECT_EQ(weight_count({.classes = 2, .width = 12, .hidden = 32}), 4970u);
}

TEST(Architecture, NamesShapesAsPyTorchDoes) {
  const Plan plan = make_plan({});
  ASSERT_EQ(plan.layers.size(), 6u);
  EXPECT_EQ(plan.layers[0].name, "tree.0");
  EXPECT_EQ(plan.layers[0].weight_shape, (std::vector<std::size_t>{8, 6, 12}));
  EXPECT_EQ(plan.layers[0].bias_shape, (std::vector<std::size_t>{8, 6}));
  EXPECT_EQ(plan.layers[3].name, "mlp.0");
  EXPECT_EQ(plan.layers[3].weight_shape, (std::vector<std::size_t>{16, 12}));
  EXPECT_EQ(plan.layers[5].weight_shape, (std::vector<std::size_t>{3, 16}));
}

TEST(Architecture, RefusesWhatCannotBeBuilt) {
  for (const Architecture& a :
       {Architecture{.scales = 12}, Architecture{.scales = 2}, Architecture{.scales = -4},
        Architecture{.features = 0}, Architecture{.classes = 1}, Architecture{.width = -1},
        Architecture{.hidden = 0}, Architecture{.kind = NetworkKind::kCnn, .features = 1}}) {
    EXPECT_ERROR(ErrorKind::kUsage, make_plan(a));
  }
}

TEST(Network, StartsWithinGlorotsBoundsAndWithoutBias) {
  const Network network = make_network({}, 7);
  const Plan plan = make_plan({});
  ASSERT_EQ(network.parameters.size(), plan.parameters);
  const Layer& tree = plan.layers[0];
  const float bound = std::sqrt(6.0f / (12 + 6));
  float largest = 0.0f;
  for (std::size_t i = tree.weight; i < tree.bias; ++i) {
    largest = std::max(largest, std::abs(network.parameters[i]));
  }
  EXPECT_LE(largest, bound);
  EXPECT_GT(largest, 0.95f * bound);  // of 576 uniform numbers
  for (std::size_t i = tree.bias; i < tree.bias + 48; ++i) EXPECT_EQ(network.parameters[i], 0.0f);
  EXPECT_EQ(make_network({}, 7).parameters, network.parameters);
  EXPECT_NE(make_network({}, 8).parameters, network.parameters);
}

}  // namespace
}  // namespace pcednet::nn
