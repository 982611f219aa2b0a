#include "pcednet/nn/predict.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/standardise.h"
#include "reference.h"
#include "support/expect_error.h"

namespace pcednet::nn {
namespace {

Model random_model(const Architecture& architecture, std::uint64_t seed) {
  Model model;
  model.network = make_network(architecture, seed);
  const std::vector<float> biases = random_numbers(model.network.parameters.size(), seed + 1, 0.3);
  for (std::size_t i = 0; i < biases.size(); ++i) model.network.parameters[i] += biases[i];
  model.standardisation = no_standardisation(architecture.inputs());
  return model;
}

/// The paper's six features: all but the last change sign with the normals; the second decides.
SignRule paper_signs(Symmetry symmetry) {
  return {symmetry, {1, 1, 1, 1, 1, 0}, 1};
}

std::vector<float> flipped(std::vector<float> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % 6 != 5) samples[i] = -samples[i];
  }
  return samples;
}

bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(Predict, AgreesWithTheReferenceInDouble) {
  for (const Architecture& architecture : various_architectures()) {
    const Model model = random_model(architecture, 3);
    const std::vector<double> parameters = to_double(model.network.parameters);
    const auto inputs = static_cast<std::size_t>(architecture.inputs());
    const auto classes = static_cast<std::size_t>(architecture.classes);
    const std::vector<float> samples = random_numbers(67 * inputs, 5);
    const std::vector<float> found = predict(model, samples);
    ASSERT_EQ(found.size(), 67 * classes);
    for (std::size_t i = 0; i < 67; ++i) {
      const auto sample = to_double(std::span(samples).subspan(i * inputs, inputs));
      const auto wanted = reference::softmax(reference::logits(architecture, parameters, sample));
      for (std::size_t c = 0; c < classes; ++c) {
        // A few roundings of float per layer.
        EXPECT_NEAR(found[i * classes + c], wanted[c], 2e-6);
      }
    }
  }
}

TEST(Predict, StandardisesBeforeTheNetwork) {
  Model model = random_model({}, 3);
  const std::vector<float> samples = random_numbers(40 * 96, 6);
  const std::vector<float> wanted = predict(model, samples);
  std::vector<float> moved = samples;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto u = static_cast<float>(i % 96);
    model.standardisation.mean[i % 96] = u;
    model.standardisation.inverse_deviation[i % 96] = 4.0f;
    moved[i] = 0.25f * moved[i] + u;
  }
  const std::vector<float> found = predict(model, moved);
  // 0.25 x + 95 keeps about 18 bits of x.
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-4);
}

TEST(Predict, LimitsFarInputs) {
  Model model = random_model({}, 3);
  model.standardisation.bound = 5.0f;
  const auto at = [&](float x) { return predict(model, std::vector<float>(96, x)); };
  EXPECT_TRUE(same_bytes(at(7.0f), at(5.0f)));
  EXPECT_TRUE(same_bytes(at(-1e30f), at(-5.0f)));
  EXPECT_FALSE(same_bytes(at(4.0f), at(5.0f)));
}

TEST(Predict, TakesInputsThatAreNoNumbersForZero) {
  const Model model = random_model({}, 3);
  std::vector<float> samples(96, 0.0f);
  const std::vector<float> wanted = predict(model, samples);
  samples[3] = std::numeric_limits<float>::quiet_NaN();
  samples[17] = std::numeric_limits<float>::infinity();
  samples[18] = -std::numeric_limits<float>::infinity();
  EXPECT_TRUE(same_bytes(predict(model, samples), wanted));
}

TEST(Predict, GivesProbabilitiesEvenForHugeWeightsAndInputs) {
  Model model = random_model({}, 3);
  for (float& w : model.network.parameters) w *= 1e30f;
  const std::vector<float> p = predict(model, random_numbers(96 * 100, 4, 1e30));
  for (std::size_t i = 0; i < p.size(); i += 3) {
    EXPECT_NEAR(p[i] + p[i + 1] + p[i + 2], 1.0f, 1e-6f);
  }
}

TEST(Predict, HasTheSameBytesWithEveryInstructionSetAndThreadCount) {
  for (const Architecture& architecture : various_architectures()) {
    const Model model = random_model(architecture, 3);
    const auto inputs = static_cast<std::size_t>(architecture.inputs());
    const std::size_t count = 5000;  // two tasks
    const std::vector<float> samples = random_numbers(count * inputs, 5, 2.0);
    const std::vector<float> wanted = predict(model, samples);
    for (const InstructionSet instructions : usable_instruction_sets()) {
      for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        std::vector<float> found(wanted.size());
        predict_into(model, samples, found, nullptr, instructions);
        EXPECT_TRUE(same_bytes(found, wanted))
            << "instruction set " << static_cast<int>(instructions);
      }
    }
    set_thread_count(0);
  }
}

TEST(Predict, DependsOnTheSampleAlone) {
  const Model model = random_model({}, 3);
  const std::vector<float> samples = random_numbers(96 * 50, 5);
  const std::vector<float> all = predict(model, samples);
  for (std::size_t i = 0; i < 50; ++i) {
    const std::vector<float> one(samples.begin() + static_cast<std::ptrdiff_t>(96 * i),
                                 samples.begin() + static_cast<std::ptrdiff_t>(96 * (i + 1)));
    const std::vector<float> alone = predict(model, one);
    EXPECT_EQ(std::memcmp(alone.data(), all.data() + 3 * i, 3 * sizeof(float)), 0);
  }
}

TEST(Predict, AnswersFlippedNormalsWithTheSameBytes) {
  std::vector<float> samples = random_numbers(96 * 200, 5, 3.0);
  for (std::size_t i = 0; i < samples.size(); i += 7) samples[i] = 0.0f;  // empty scales
  for (std::size_t i = 96; i < 96 * 40; i += 6) samples[i + 1] = 0.0f;    // nothing decides
  for (std::size_t i = 0; i < 96; ++i) samples[i] = 0.0f;
  for (const Symmetry symmetry : {Symmetry::kAverage, Symmetry::kCanonical}) {
    Model model = random_model({}, 3);
    model.sign_rule = paper_signs(symmetry);
    model.standardisation.bound = 2.0f;
    EXPECT_TRUE(same_bytes(predict(model, samples), predict(model, flipped(samples))));
  }
  Model plain = random_model({}, 3);
  EXPECT_FALSE(same_bytes(predict(plain, samples), predict(plain, flipped(samples))));
}

TEST(Predict, AveragesTheLogitsOfASampleAndItsTwin) {
  Model model = random_model({}, 3);
  model.sign_rule = paper_signs(Symmetry::kAverage);
  const std::vector<float> samples = random_numbers(96 * 40, 5);
  const std::vector<float> found = predict(model, samples);
  const std::vector<float> twins = flipped(samples);
  const std::vector<double> parameters = to_double(model.network.parameters);
  for (std::size_t i = 0; i < 40; ++i) {
    auto z = reference::logits({}, parameters, to_double(std::span(samples).subspan(96 * i, 96)));
    const auto y =
        reference::logits({}, parameters, to_double(std::span(twins).subspan(96 * i, 96)));
    for (std::size_t c = 0; c < 3; ++c) z[c] = 0.5 * (z[c] + y[c]);
    const auto wanted = reference::softmax(z);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[3 * i + c], wanted[c], 2e-6);
  }
}

TEST(Predict, OrientsASampleByItsDecidingFeature) {
  Model model = random_model({}, 3);
  const std::vector<float> samples = random_numbers(96 * 64, 5);
  const std::vector<float> plain = predict(model, samples);
  const std::vector<float> twins = predict(model, flipped(samples));
  model.sign_rule = paper_signs(Symmetry::kCanonical);
  const std::vector<float> found = predict(model, samples);
  for (std::size_t i = 0; i < 64; ++i) {
    float sum = 0.0f;
    for (std::size_t s = 0; s < 16; ++s) sum += samples[96 * i + 6 * s + 1];
    const std::vector<float>& wanted = sum < 0.0f ? twins : plain;
    EXPECT_EQ(std::memcmp(found.data() + 3 * i, wanted.data() + 3 * i, 3 * sizeof(float)), 0);
  }
}

TEST(Predict, RefusesWhatDoesNotFit) {
  const Model model = random_model({}, 3);
  EXPECT_ERROR(ErrorKind::kUsage, predict(model, std::vector<float>(97)));
  EXPECT_TRUE(predict(model, std::vector<float>()).empty());
  Model short_of_weights = model;
  short_of_weights.network.parameters.pop_back();
  EXPECT_ERROR(ErrorKind::kUsage, predict(short_of_weights, std::vector<float>(96)));
  Model undecided = model;
  undecided.sign_rule = {Symmetry::kCanonical, {1, 1, 1, 1, 1, 0}, 5};
  EXPECT_ERROR(ErrorKind::kUsage, predict(undecided, std::vector<float>(96)));
}

TEST(Predict, StopsWhenAsked) {
  const Model model = random_model({}, 3);
  const Progress progress{{}, [] { return true; }};
  EXPECT_ERROR(ErrorKind::kCancelled, predict(model, std::vector<float>(96), &progress));
}

}  // namespace
}  // namespace pcednet::nn
