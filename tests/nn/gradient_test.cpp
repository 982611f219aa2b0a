#include "pcednet/nn/gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "pcednet/core/parallel.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/standardise.h"
#include "reference.h"

namespace pcednet::nn {
namespace {

struct Problem {
  Model model;
  std::vector<float> samples;
  std::vector<std::uint8_t> labels;
  std::vector<std::uint32_t> chosen;

  TrainingSet set() const { return {samples, labels}; }
};

Problem make_problem(const Architecture& architecture, std::size_t count) {
  Problem problem;
  problem.model.network = make_network(architecture, 11);
  // Away from zero, so that no ReLU stands exactly at its corner.
  for (float& w : problem.model.network.parameters) {
    if (w == 0.0f) w = 0.01f;
  }
  problem.model.standardisation = no_standardisation(architecture.inputs());
  problem.samples = random_numbers(count * static_cast<std::size_t>(architecture.inputs()), 12);
  Random random(13);
  for (std::size_t i = 0; i < count; ++i) {
    problem.labels.push_back(
        static_cast<std::uint8_t>(random.index(static_cast<std::size_t>(architecture.classes))));
  }
  problem.chosen.resize(count);
  std::iota(problem.chosen.begin(), problem.chosen.end(), 0u);
  return problem;
}

/// Mean cross-entropy in double.
double reference_loss(const Problem& problem, std::span<const double> parameters, bool average) {
  const Architecture& a = problem.model.network.architecture;
  const auto inputs = static_cast<std::size_t>(a.inputs());
  const auto classes = static_cast<std::size_t>(a.classes);
  double loss = 0.0;
  for (const std::uint32_t i : problem.chosen) {
    auto sample = to_double(std::span(problem.samples).subspan(i * inputs, inputs));
    auto z = reference::logits(a, parameters, sample);
    if (average) {
      const auto& odd = problem.model.sign_rule.odd_features;
      for (std::size_t u = 0; u < inputs; ++u) {
        if (odd[u % odd.size()]) sample[u] = -sample[u];
      }
      const auto y = reference::logits(a, parameters, sample);
      for (std::size_t c = 0; c < classes; ++c) z[c] = 0.5 * (z[c] + y[c]);
    }
    const auto p = reference::softmax(z);
    loss -= std::log(p[problem.labels[i]]);
  }
  return loss / static_cast<double>(problem.chosen.size());
}

/// Compares every derivative with a central difference of the reference.
void expect_right_gradient(const Problem& problem, bool average) {
  std::vector<double> parameters = to_double(problem.model.network.parameters);
  std::vector<float> gradient(parameters.size());
  GradientMachine machine(problem.model);
  const double loss = machine.run(problem.set(), problem.chosen, gradient);
  EXPECT_NEAR(loss, reference_loss(problem, parameters, average), 2e-6);
  double largest = 0.0;
  for (const float g : gradient) largest = std::max(largest, std::abs(static_cast<double>(g)));
  EXPECT_GT(largest, 1e-3);
  constexpr double kStep = 1e-5;  // truncation about 1e-10, rounding about 1e-11
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double kept = parameters[i];
    parameters[i] = kept + kStep;
    const double above = reference_loss(problem, parameters, average);
    parameters[i] = kept - kStep;
    const double below = reference_loss(problem, parameters, average);
    parameters[i] = kept;
    // Float sums of numbers of the size of the largest derivatives.
    ASSERT_NEAR(gradient[i], (above - below) / (2 * kStep), 3e-6 * std::max(largest, 0.1))
        << "parameter " << i;
  }
}

TEST(Gradient, IsTheDerivativeByEveryParameter) {
  for (const Architecture& architecture : various_architectures()) {
    SCOPED_TRACE(weight_count(architecture));
    expect_right_gradient(make_problem(architecture, 5), false);
  }
}

TEST(Gradient, IsRightWithSoftTargets) {
  Problem problem = make_problem({}, 7);
  // A mixture of hard labels has the mixture of their losses, and of their gradients.
  const std::size_t classes = 3, count = problem.labels.size();
  std::vector<float> targets(count * classes);
  const std::vector<float> shares = {0.5f, 0.3f, 0.2f};
  for (std::size_t i = 0; i < targets.size(); ++i) targets[i] = shares[i % classes];
  const std::size_t n = problem.model.network.parameters.size();
  std::vector<float> found(n), part(n);
  std::vector<double> wanted(n, 0.0);
  GradientMachine machine(problem.model);
  double wanted_loss = 0.0;
  TrainingSet set = problem.set();
  for (std::uint8_t c = 0; c < classes; ++c) {
    const std::vector<std::uint8_t> all(count, c);
    set.labels = all;
    wanted_loss += static_cast<double>(shares[c]) * machine.run(set, problem.chosen, part);
    for (std::size_t k = 0; k < n; ++k) wanted[k] += static_cast<double>(shares[c] * part[k]);
  }
  set = problem.set();
  set.targets = targets;
  EXPECT_NEAR(machine.run(set, problem.chosen, found), wanted_loss, 1e-6);
  for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(found[k], wanted[k], 1e-6);
}

TEST(Gradient, IsThatOfTheAveragedLogits) {
  Problem problem = make_problem({}, 7);
  problem.model.sign_rule = {Symmetry::kAverage, {1, 1, 1, 1, 1, 0}, 1};
  expect_right_gradient(problem, true);
}

TEST(Gradient, OfSeveralChunksIsTheMeanOfItsSamples) {
  Problem problem = make_problem({.scales = 4, .hidden = 4}, 300);
  const std::size_t n = problem.model.network.parameters.size();
  GradientMachine machine(problem.model);
  std::vector<float> whole(n), one(n);
  const double loss = machine.run(problem.set(), problem.chosen, whole);
  std::vector<double> mean(n, 0.0);
  double mean_loss = 0.0;
  for (const std::uint32_t i : problem.chosen) {
    mean_loss += machine.run(problem.set(), std::span(&i, 1), one) / 300;
    for (std::size_t k = 0; k < n; ++k) mean[k] += one[k] / 300.0;
  }
  EXPECT_NEAR(loss, mean_loss, 1e-6);
  for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(whole[k], mean[k], 1e-6);
}

TEST(Gradient, HasTheSameBytesWithEveryInstructionSetAndThreadCount) {
  for (const Architecture& architecture : various_architectures()) {
    Problem problem = make_problem(architecture, 700);
    std::vector<float> wanted(problem.model.network.parameters.size());
    const double loss = GradientMachine(problem.model).run(problem.set(), problem.chosen, wanted);
    for (const InstructionSet instructions : usable_instruction_sets()) {
      for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        std::vector<float> found(wanted.size());
        GradientMachine machine(problem.model, instructions);
        EXPECT_EQ(machine.run(problem.set(), problem.chosen, found), loss);
        EXPECT_EQ(found, wanted);
      }
    }
    set_thread_count(0);
  }
}

}  // namespace
}  // namespace pcednet::nn
