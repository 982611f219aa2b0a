#include "pcednet/nn/model_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "pcednet/core/error.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/standardise.h"
#include "reference.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::nn {
namespace {

Model example_model(const Architecture& architecture) {
  Model model;
  model.network = make_network(architecture, 3);
  model.standardisation = no_standardisation(architecture.inputs());
  for (std::size_t u = 0; u < model.standardisation.mean.size(); ++u) {
    const bool odd = u % static_cast<std::size_t>(architecture.features) == 0;
    model.standardisation.mean[u] = odd ? 0.0f : 0.1f * static_cast<float>(u);
    model.standardisation.inverse_deviation[u] = 1.0f / static_cast<float>(u + 1);
  }
  model.standardisation.bound = 4.5f;
  std::vector<std::uint8_t> odd(static_cast<std::size_t>(architecture.features), 0);
  odd[0] = 1;
  model.sign_rule = {Symmetry::kCanonical, odd, 0};
  for (int c = 0; c < architecture.classes; ++c)
    model.class_names.push_back("c" + std::to_string(c));
  model.metadata = {{"descriptor", "{\"scales\": 16}"}, {"seed", "42"}, {"note", "Kante \xc3\xa4"}};
  return model;
}

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(a.network.architecture, b.network.architecture);
  EXPECT_EQ(a.network.parameters, b.network.parameters);
  EXPECT_EQ(a.standardisation.mean, b.standardisation.mean);
  EXPECT_EQ(a.standardisation.inverse_deviation, b.standardisation.inverse_deviation);
  EXPECT_EQ(a.standardisation.bound, b.standardisation.bound);
  EXPECT_EQ(a.sign_rule.symmetry, b.sign_rule.symmetry);
  EXPECT_EQ(a.sign_rule.odd_features, b.sign_rule.odd_features);
  EXPECT_EQ(a.sign_rule.deciding_feature, b.sign_rule.deciding_feature);
  EXPECT_EQ(a.class_names, b.class_names);
  EXPECT_EQ(a.metadata, b.metadata);
}

class ModelFile : public testing::Test, protected test::OwnFolder {};

TEST_F(ModelFile, KeepsEverything) {
  for (const Architecture& architecture : various_architectures()) {
    const Model model = example_model(architecture);
    write_safetensors(path("keeps"), to_safetensors(model), Overwrite::kYes);
    expect_same(from_safetensors(read_safetensors(path("keeps")), "keeps"), model);
  }
}

TEST_F(ModelFile, HasTheSameBytesForTheSameModel) {
  const Model model = example_model({});
  const std::string bytes = encode_safetensors(to_safetensors(model));
  EXPECT_EQ(bytes, encode_safetensors(to_safetensors(model)));
  EXPECT_EQ(bytes, encode_safetensors(decode_safetensors(bytes, "again")));
}

TEST_F(ModelFile, KeepsItsOwnMetadataApart) {
  Model model = example_model({});
  model.metadata["nn.kind"] = "mine";
  EXPECT_ERROR(ErrorKind::kUsage, to_safetensors(model));
}

TEST_F(ModelFile, RefusesEveryTruncation) {
  const std::string bytes = encode_safetensors(to_safetensors(example_model({.scales = 4})));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_ERROR(ErrorKind::kModelMismatch, decode_safetensors(bytes.substr(0, length), "cut"))
        << length;
  }
  EXPECT_ERROR(ErrorKind::kModelMismatch, decode_safetensors(bytes + '\0', "long"));
}

TEST_F(ModelFile, TakesOrRefusesDamagedBytesButNeverFails) {
  const std::string bytes = encode_safetensors(to_safetensors(example_model({.scales = 4})));
  Random random(5);
  int refused = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    std::string damaged = bytes;
    const int flips = 1 + static_cast<int>(random.index(4));
    for (int f = 0; f < flips; ++f) {
      // Mostly in the header, where it matters.
      const std::size_t range = trial % 4 ? 2000 : bytes.size();
      damaged[random.index(std::min(range, bytes.size()))] = static_cast<char>(random.next());
    }
    const auto error =
        test::error_of([&] { from_safetensors(decode_safetensors(damaged, "x"), "x"); });
    if (!error) continue;
    EXPECT_EQ(error->kind(), ErrorKind::kModelMismatch) << error->what();
    ++refused;
  }
  EXPECT_GT(refused, 2500);
}

TEST_F(ModelFile, NamesTheFileAndThePlace) {
  const std::string bytes = encode_safetensors(to_safetensors(example_model({})));
  const auto message = [](const std::string& damaged) -> std::string {
    const auto error = test::error_of([&] { decode_safetensors(damaged, "some.safetensors"); });
    return error ? error->what() : "";
  };
  EXPECT_NE(message(bytes.substr(0, 5)).find("some.safetensors: byte 5"), std::string::npos);
  std::string broken = bytes;
  broken[8 + 1] = '}';
  EXPECT_NE(message(broken).find("byte 1"), std::string::npos) << message(broken);
}

std::string with_header(const std::string& header, const std::string& data) {
  const std::uint64_t length = header.size();
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &length, 8);
  return bytes + header + data;
}

TEST(Safetensors, RefusesWhatTheFormatForbids) {
  const std::string good =
      R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},"b":{"dtype":"F32","shape":[],"data_offsets":[8,12]}})";
  const Safetensors read = decode_safetensors(with_header(good, std::string(12, '\0')), "good");
  EXPECT_EQ(read.tensors.at("a").values.size(), 2u);
  EXPECT_EQ(read.tensors.at("b").values.size(), 1u);
  const std::vector<std::string> bad = {
      "",
      "[]",
      "3",
      "{",
      "{}x",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,12]},"a":{"dtype":"F32","shape":[3],"data_offsets":[0,12]}})",
      R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},"b":{"dtype":"F32","shape":[2],"data_offsets":[4,12]}})",
      R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},"b":{"dtype":"F32","shape":[1],"data_offsets":[8,12]}})",
      R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})",
      R"({"a":{"dtype":"F64","shape":[3],"data_offsets":[0,12]}})",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,16]}})",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[12,0]}})",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0]}})",
      R"({"a":{"dtype":"F32","shape":[-3],"data_offsets":[0,12]}})",
      R"({"a":{"dtype":"F32","shape":[3.0],"data_offsets":[0,12]}})",
      R"({"a":{"dtype":"F32","shape":[4611686018427387904,4],"data_offsets":[0,12]}})",
      R"({"a":{"dtype":"F32","shape":3,"data_offsets":[0,12]}})",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,12],"more":1}})",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,12]},"__metadata__":{"k":1}})",
      R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,12]},"__metadata__":[]})",
      R"({"a":{"dtype":"F32","shape":[[[3]]],"data_offsets":[0,12]}})",
      R"({"a":[]})",
  };
  for (const std::string& header : bad) {
    EXPECT_ERROR(ErrorKind::kModelMismatch,
                 decode_safetensors(with_header(header, std::string(12, '\0')), "bad"))
        << header;
  }
  EXPECT_ERROR(ErrorKind::kModelMismatch,
               decode_safetensors(with_header(std::string(1000000, '['), ""), "deep"));
}

TEST_F(ModelFile, RefusesForeignAndUnfittingContent) {
  const Safetensors good = to_safetensors(example_model({}));
  const auto expect_refused = [&](const std::function<void(Safetensors&)>& change) {
    Safetensors content = good;
    change(content);
    EXPECT_ERROR(ErrorKind::kModelMismatch, from_safetensors(content, "x"));
  };
  from_safetensors(good, "good");
  expect_refused([](Safetensors& c) { c.metadata.clear(); });
  expect_refused([](Safetensors& c) { c.metadata["nn.format"] = "pcednet network 2"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.kind"] = "ResNet"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.scales"] = "17"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.scales"] = "32"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.scales"] = "16 "; });
  expect_refused([](Safetensors& c) { c.metadata["nn.scales"] = "99999999999"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.classes"] = "4"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.class_names"] = "[\"a\"]"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.class_names"] = "[1,2,3]"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.squash"] = "soft"; });
  expect_refused([](Safetensors& c) { c.metadata.erase("nn.squash"); });
  expect_refused([](Safetensors& c) { c.metadata["nn.odd_features"] = "[1,1,1,1,1,2]"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.deciding_feature"] = "-1"; });
  expect_refused([](Safetensors& c) { c.metadata["nn.deciding_feature"] = "3"; });
  expect_refused([](Safetensors& c) { c.tensors.erase("mlp.1.bias"); });
  expect_refused([](Safetensors& c) { c.tensors["extra"] = {{1}, {0.0f}}; });
  expect_refused([](Safetensors& c) { c.tensors["tree.0.weight"].shape = {6, 8, 12}; });
  expect_refused([](Safetensors& c) { c.tensors["standardisation.bound"].values[0] = 0.0f; });
  expect_refused([](Safetensors& c) {
    c.tensors["mlp.0.weight"].values[5] = std::numeric_limits<float>::quiet_NaN();
  });
}

TEST_F(ModelFile, TellsAMissingFileFromADamagedOne) {
  EXPECT_ERROR(ErrorKind::kUnreadable, read_safetensors(folder_));
  const auto error = test::error_of([] { read_safetensors("/no/such.safetensors"); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kUnreadable);
  EXPECT_STREQ(error->what(), "/no/such.safetensors: No such file or directory");
  write_text_file(path("foreign"), "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
  EXPECT_ERROR(ErrorKind::kModelMismatch, read_safetensors(path("foreign")));
}

}  // namespace
}  // namespace pcednet::nn
