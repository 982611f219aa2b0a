#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>

#include "pcednet/nn/gradient.h"
#include "pcednet/nn/model_file.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/predict.h"
#include "pcednet/nn/standardise.h"
#include "reference.h"
#include "support/own_folder.h"

namespace pcednet::nn {
namespace {

namespace fs = std::filesystem;

constexpr int kSkipped = 77;  // what the scripts return without the packages they need

int run_script(const std::string& script, const fs::path& folder) {
  const std::string command = "/usr/bin/python3 -B '" PCEDNET_SOURCE_DIR "/tests/nn/" + script +
                              "' '" + folder.string() + "'";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Writes a model, and beside it samples with the answers and derivatives that we compute.
void write_case(const fs::path& folder, const std::string& name, const Architecture& architecture,
                Symmetry symmetry) {
  Model model;
  model.network = make_network(architecture, 21);
  model.standardisation = no_standardisation(architecture.inputs());
  model.standardisation.bound = 3.0f;
  for (float& factor : model.standardisation.inverse_deviation) factor = 1.5f;
  model.sign_rule.odd_features.assign(static_cast<std::size_t>(architecture.features), 1);
  model.sign_rule.odd_features.back() = 0;
  model.sign_rule.symmetry = symmetry;
  model.metadata["seed"] = "21";
  write_safetensors(folder / (name + ".model.safetensors"), to_safetensors(model));

  constexpr std::size_t kCount = 200;
  const auto inputs = static_cast<std::size_t>(architecture.inputs());
  const auto classes = static_cast<std::size_t>(architecture.classes);
  const std::vector<float> samples = random_numbers(kCount * inputs, 22);
  std::vector<std::uint8_t> labels(kCount);
  for (std::size_t i = 0; i < kCount; ++i) labels[i] = static_cast<std::uint8_t>(i % classes);
  std::vector<std::uint32_t> chosen(kCount);
  std::iota(chosen.begin(), chosen.end(), 0u);
  std::vector<float> gradient(model.network.parameters.size());
  const double loss = GradientMachine(model).run({samples, labels}, chosen, gradient);

  Safetensors answers;
  answers.tensors["samples"] = {{kCount, inputs}, samples};
  answers.tensors["labels"] = {{kCount}, {labels.begin(), labels.end()}};
  answers.tensors["probabilities"] = {{kCount, classes}, predict(model, samples)};
  answers.tensors["loss"] = {{}, {static_cast<float>(loss)}};
  Model derivatives = model;  // named and shaped like the parameters
  derivatives.network.parameters = gradient;
  for (const auto& [key, tensor] : to_safetensors(derivatives).tensors) {
    answers.tensors["gradient." + key] = tensor;
  }
  write_safetensors(folder / (name + ".answers.safetensors"), answers);
}

void write_cases(const fs::path& folder) {
  int number = 0;
  for (const Architecture& architecture : various_architectures()) {
    for (const Symmetry symmetry : {Symmetry::kNone, Symmetry::kAverage, Symmetry::kCanonical}) {
      write_case(folder, "case" + std::to_string(number++), architecture, symmetry);
    }
  }
}

class Python : public testing::Test, protected test::OwnFolder {};

TEST_F(Python, NumpyReadsAndRunsOurModels) {
  write_cases(folder_);
  const int code = run_script("numpy_model.py", folder_);
  if (code == kSkipped) GTEST_SKIP() << "no numpy";
  EXPECT_EQ(code, 0);
}

TEST_F(Python, PyTorchComputesTheSameAnswersAndDerivatives) {
  write_cases(folder_);
  const int code = run_script("torch_parity.py", folder_);
  if (code == kSkipped) GTEST_SKIP() << "no PyTorch";
  EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace pcednet::nn
