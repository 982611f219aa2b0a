#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "pcednet/core/version.h"
#include "pcednet/detect/model.h"
#include "pcednet/nn/predict.h"
#include "pcednet/nn/safetensors.h"
#include "support/own_folder.h"

// A model file of every format that there has been, which must stay readable. They were made by
//   pcednet generate default DIR --paper-only
//   pcednet train DIR/cube_0.ply DIR/icosahedron_0.ply -o model_1.safetensors --classes 2 --natural
//     --gate 0.4 --second-gate -0.3 --epochs 40
//   pcednet train DIR/cube_0.ply DIR/icosahedron_0.ply -o model_2.safetensors --natural --context
//     --epochs 40
//   the same with --seed 2 -o few.safetensors, and with
//     --expert few.safetensors below=1000,estimated -o model_4.safetensors
//   the command of model_2 with -o model_5.safetensors, without --context, after comments with the
//     three classes of kOwn were put into the headers of both clouds; with -o model_6.safetensors
//     after those of edges and `upper part`, 4, which the highest fifth of the non-edge points got
// and the answers, to descriptors of twelve points of the icosahedron and for the context network
// to random numbers, by numpy alone, in double precision (the functions of
// tests/nn/numpy_model.py).

namespace pcednet::detect {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(PCEDNET_SOURCE_DIR) / "tests/detect/golden";

const ClassTable kOwn = {
    {"wall", {200, 200, 200}}, {"pipe rail", {0x11, 0x22, 0x33}}, {"edge of it", {170, 0, 0}}};

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class GoldenModel : public testing::TestWithParam<std::string> {
 protected:
  const fs::path path_ = kFolder / (GetParam() + ".safetensors");
  const nn::Safetensors answers_ =
      nn::read_safetensors(kFolder / (GetParam() + ".answers.safetensors"));

  void expect_answers(const nn::Model& network, const std::string& prefix) const {
    const auto& expected = answers_.tensors.at(prefix + "probabilities").values;
    const auto found = nn::predict(network, answers_.tensors.at(prefix + "samples").values);
    ASSERT_EQ(found.size(), 12 * network.class_names.size());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i], expected[i], 3e-6) << prefix << i;  // a few roundings of float
    }
  }
};

TEST_P(GoldenModel, GivesItsKnownAnswers) {
  const EdgeModel model = load_model(path_);
  expect_answers(model.network, "");
  ASSERT_EQ(model.context.has_value(), answers_.tensors.contains("context_samples"));
  if (model.context) expect_answers(*model.context, "context_");
  ASSERT_EQ(model.experts.size(), answers_.tensors.contains("expert_samples") ? 1u : 0u);
  ASSERT_EQ(model.pieces.has_value(), answers_.tensors.contains("pieces_samples"));
  if (model.pieces) expect_answers(*model.pieces, "pieces_");
  if (model.experts.empty()) return;
  expect_answers(model.experts[0].network, "expert_");
  expect_answers(*model.experts[0].context, "expert_context_");
}

TEST_P(GoldenModel, IsWrittenWithTheSameBytes) {
  const test::OwnFolder folder;
  save_model(folder.path("a"), load_model(path_), Overwrite::kNo);
  const std::string written = bytes_of(folder.path("a"));
  nn::Safetensors content = nn::read_safetensors(path_);
  EXPECT_EQ(nn::encode_safetensors(content), bytes_of(path_));
  content.metadata["version"] = kVersion;  // of the program that writes, all else is the model's
  EXPECT_EQ(written, nn::encode_safetensors(content));
}

INSTANTIATE_TEST_SUITE_P(OfFormat, GoldenModel,
                         testing::Values("model_1", "model_2", "model_4", "model_5", "model_6",
                                         "model_7"),
                         [](const auto& tested) { return tested.param; });

TEST(GoldenModels, SayHowPointsAreDescribed) {
  const EdgeModel one = load_model(kFolder / "model_1.safetensors");
  EXPECT_EQ(one.name, "model_1");
  EXPECT_EQ(one.seed, 1u);
  EXPECT_EQ(one.classes, (std::vector<std::uint8_t>{0, 2}));
  EXPECT_EQ(one.descriptor.scales, 16);
  EXPECT_EQ(one.descriptor.side_gate, 0.4);
  EXPECT_EQ(one.descriptor.second_gate, -0.3);
  EXPECT_EQ(one.network.metadata.at("training_epochs"), "40");
  const EdgeModel two = load_model(kFolder / "model_2.safetensors");
  EXPECT_EQ(two.classes, (std::vector<std::uint8_t>{0, 1, 2}));
  EXPECT_FALSE(two.descriptor.side_gate);
  EXPECT_FALSE(two.descriptor.second_gate);
  EXPECT_EQ(two.network.sign_rule.symmetry, nn::Symmetry::kAverage);
  EXPECT_EQ(load_model(kFolder / "model_4.safetensors").experts[0].kind,
            (CloudKind{.below = 1000, .estimated = true}));
}

TEST(GoldenModels, NameTheirOwnClasses) {
  const EdgeModel five = load_model(kFolder / "model_5.safetensors");
  EXPECT_EQ(five.table, kOwn);
  EXPECT_EQ(five.classes, (std::vector<std::uint8_t>{0, 1, 2}));
  EXPECT_FALSE(five.context);
  const EdgeModel six = load_model(kFolder / "model_6.safetensors");
  ClassTable table = edge_classes();
  table.push_back({"upper part", {0x11, 0x22, 0x33}});
  EXPECT_EQ(six.table, table);
  EXPECT_EQ(six.classes, (std::vector<std::uint8_t>{0, 1, 2, 4}));
  EXPECT_TRUE(six.context);
}

}  // namespace
}  // namespace pcednet::detect
