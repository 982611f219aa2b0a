#include "pcednet/nn/train.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/nn/distil.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/predict.h"
#include "reference.h"
#include "support/expect_error.h"

namespace pcednet::nn {
namespace {

struct Labelled {
  std::vector<float> samples;
  std::vector<std::uint8_t> labels;

  TrainingSet set() const { return {samples, labels}; }
};

constexpr Architecture kSmall = {.scales = 4, .features = 3, .classes = 3};

/// Three classes told apart by how the first feature changes over the scales: it stays flat, rises
/// slowly or rises fast, under noise. Class 0 is ten times as frequent as each of the others.
Labelled rising_features(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Labelled data;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t draw = random.index(12);
    const auto label = static_cast<std::uint8_t>(draw == 10 ? 1 : draw == 11 ? 2 : 0);
    for (int s = 0; s < 4; ++s) {
      data.samples.push_back(static_cast<float>(10.0 + label * s + 0.2 * random.normal()));
      data.samples.push_back(static_cast<float>(1e3 * random.normal()));
      data.samples.push_back(0.5f);
    }
    data.labels.push_back(label);
  }
  return data;
}

double share_right(const Model& model, const Labelled& data) {
  const std::vector<float> p = predict(model, data.samples);
  std::size_t right = 0;
  for (std::size_t i = 0; i < data.labels.size(); ++i) {
    const float* row = p.data() + 3 * i;
    right += std::max_element(row, row + 3) - row == data.labels[i];
  }
  return static_cast<double>(right) / static_cast<double>(data.labels.size());
}

/// Classes 0 and 1 that overlap: no network can be sure.
Labelled doubtful(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Labelled data;
  for (std::size_t i = 0; i < count; ++i) {
    const auto label = static_cast<std::uint8_t>(random.index(2));
    for (int u = 0; u < 12; ++u) {
      data.samples.push_back(static_cast<float>(0.3 * label + random.normal()));
    }
    data.labels.push_back(label);
  }
  return data;
}

double mean_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(std::abs(a[i] - b[i]));
  return sum / static_cast<double>(a.size());
}

TEST(Distil, EvensOutWhatNetworksFindByChance) {
  const Architecture architecture = {.scales = 4, .features = 3, .classes = 2};
  const Labelled data = doubtful(300, 1), unseen = doubtful(2000, 2);
  const auto answer = [&](std::uint64_t seed, int teachers) {
    const TrainOptions options = {.epochs = 6, .seed = seed};
    return predict(distil(architecture, data.set(), options, teachers).best, unseen.samples);
  };
  EXPECT_LT(mean_difference(answer(1, 6), answer(2, 6)),
            0.8 * mean_difference(answer(1, 0), answer(2, 0)));
}

TEST(Train, LearnsASeparableProblemWithRareClasses) {
  const TrainResult result = train(kSmall, rising_features(3000, 1).set(), {.epochs = 10});
  EXPECT_FALSE(result.cancelled);
  ASSERT_EQ(result.history.size(), 10u);
  EXPECT_LT(result.history.back().training_loss, 0.5 * result.history.front().training_loss);
  EXPECT_GT(result.history.back().validation_accuracy, 0.99);
  EXPECT_GT(share_right(result.best, rising_features(3000, 2)), 0.99);
}

TEST(Train, LearnsFromSixtyPoints) {
  const TrainResult result = train(kSmall, rising_features(60, 1).set());
  EXPECT_GT(share_right(result.best, rising_features(3000, 2)), 0.97);
}

TEST(Train, FollowsThePapersRecipe) {
  Labelled data = rising_features(6000, 1);
  // Without standardisation the features must have the size that the network expects.
  for (std::size_t i = 0; i < data.samples.size(); i += 3) {
    data.samples[i] -= 10.0f;
    data.samples[i + 1] *= 1e-3f;
  }
  const TrainResult result = train(kSmall, data.set(), paper_recipe());
  ASSERT_EQ(result.history.size(), 40u);
  EXPECT_GT(share_right(result.best, data), 0.98);
}

TEST(Train, LearnsWithEitherSymmetry) {
  Labelled data = rising_features(3000, 1), other = rising_features(3000, 2);
  for (Labelled* d : {&data, &other}) {
    Random random(9);
    for (std::size_t i = 0; i < d->labels.size(); ++i) {
      const float sign = random.index(2) ? 1.0f : -1.0f;
      for (std::size_t u = 0; u < 12; u += 3) d->samples[12 * i + u] *= sign;
    }
  }
  for (const Symmetry symmetry : {Symmetry::kAverage, Symmetry::kCanonical}) {
    TrainOptions options;
    options.epochs = 20;
    options.sign_rule = {symmetry, {1, 1, 0}, 0};
    EXPECT_GT(share_right(train(kSmall, data.set(), options).best, other), 0.98);
  }
}

TEST(Train, GivesTheSameBytesForAnyNumberOfThreads) {
  const Labelled data = rising_features(2000, 1);
  const TrainOptions options{.epochs = 2, .batch = 600};
  const TrainResult wanted = train(kSmall, data.set(), options);
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    const TrainResult found = train(kSmall, data.set(), options);
    EXPECT_EQ(found.best.network.parameters, wanted.best.network.parameters);
    EXPECT_EQ(found.history.back().validation_loss, wanted.history.back().validation_loss);
  }
  set_thread_count(0);
  TrainOptions other_seed = options;
  other_seed.seed = 2;
  EXPECT_NE(train(kSmall, data.set(), other_seed).best.network.parameters,
            wanted.best.network.parameters);
}

TEST(Train, KeepsTheBestEpoch) {
  const Labelled data = rising_features(500, 1);
  TrainOptions options{.learning_rate = 0.3, .anneal = false, .epochs = 12};  // restless
  const TrainResult result = train(kSmall, data.set(), options);
  ASSERT_GT(result.best_epoch, 0);
  for (const EpochReport& report : result.history) {
    EXPECT_GE(report.validation_loss,
              result.history[static_cast<std::size_t>(result.best_epoch - 1)].validation_loss);
  }
  TrainOptions until_best = options;
  until_best.epochs = result.best_epoch;
  EXPECT_EQ(train(kSmall, data.set(), until_best).best.network.parameters,
            result.best.network.parameters);
}

TEST(Train, JudgesEpochsByTheClassesThatItLearnsFrom) {
  // One sample in ten is of the class that nothing tells apart.
  Labelled data = doubtful(6000, 1);
  for (std::size_t i = 0; i < data.labels.size(); ++i) data.labels[i] = i % 10 == 0;
  const Architecture architecture = {.scales = 4, .features = 3, .classes = 2};
  for (const auto& [balance, doubt] : {std::pair(0.0, 0.325), std::pair(1.0, std::log(2.0))}) {
    const TrainResult result = train(architecture, data.set(), {.epochs = 1, .balance = balance});
    EXPECT_NEAR(result.history.back().validation_loss, doubt, 0.1) << balance;
  }
  const TrainOptions evenly = {.epochs = 1, .balance = 0.0, .even_validation = true};
  EXPECT_GT(train(architecture, data.set(), evenly).history.back().validation_loss, 1.0);
}

TEST(Train, ReturnsTheBestSoFarWhenStopped) {
  const Labelled data = rising_features(500, 1);
  int epochs = 0;
  const Progress progress{{}, [&] { return epochs == 2; }};
  const TrainResult result = train(
      kSmall, data.set(), {}, [&](const EpochReport& report) { epochs = report.epoch; }, &progress);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(result.history.size(), 2u);
  EXPECT_GT(share_right(result.best, data), 0.5);

  const Progress at_once{{}, [] { return true; }};
  const TrainResult nothing = train(kSmall, data.set(), {}, {}, &at_once);
  EXPECT_TRUE(nothing.cancelled);
  EXPECT_EQ(nothing.best_epoch, 0);
  EXPECT_EQ(nothing.best.network.parameters, make_network(kSmall, 1).parameters);
}

TEST(Train, ReportsItsProgress) {
  std::vector<double> fractions;
  const Progress progress{[&](const std::string& stage, double fraction) {
                            EXPECT_EQ(stage, "train");
                            fractions.push_back(fraction);
                          },
                          {}};
  train(kSmall, rising_features(100, 1).set(), {.epochs = 3}, {}, &progress);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(Train, ContinuesFromAModel) {
  const Labelled data = rising_features(1000, 1);
  const Model first = train(kSmall, data.set(), {.epochs = 10}).best;
  TrainOptions options{.learning_rate = 1e-4, .epochs = 1};
  options.start = &first;
  const TrainResult more = train(kSmall, rising_features(100, 3).set(), options);
  EXPECT_GT(share_right(more.best, data), 0.98);
  EXPECT_EQ(more.best.standardisation.mean, first.standardisation.mean);
  Architecture other = kSmall;
  ++other.hidden;
  EXPECT_ERROR(ErrorKind::kUsage, train(other, data.set(), options));
}

TEST(Train, HoldsNothingOutWhenAskedTo) {
  const Labelled data = rising_features(600, 3);
  const TrainOptions options = {.epochs = 2, .least_per_epoch = 1, .held_out = 0};
  const TrainResult result = train(kSmall, data.set(), options);
  EXPECT_EQ(result.best_epoch, 2);
  for (const EpochReport& report : result.history) EXPECT_TRUE(report.validation_confusion.empty());
}

TEST(Train, LearnsAClassFromTargetsAlone) {
  // No sample is labelled 2, but what should be of it is probably so.
  Labelled data = rising_features(2000, 3);
  const std::vector<std::uint8_t> truth = data.labels;
  std::vector<float> targets;
  for (std::uint8_t& label : data.labels) {
    for (const std::uint8_t c : {0, 1, 2}) targets.push_back(c == label ? 0.8f : 0.1f);
    if (label == 2) label = 0;
  }
  const TrainOptions options = {.epochs = 20, .balance = 0, .held_out = 0};
  const Model model =
      train(kSmall, {.samples = data.samples, .labels = data.labels, .targets = targets}, options)
          .best;
  EXPECT_GT(share_right(model, {data.samples, truth}), 0.95);
}

TEST(Train, NamesAClassWithoutSamples) {
  Labelled data = rising_features(200, 1);
  for (std::uint8_t& label : data.labels) label = label == 2 ? kIgnoredLabel : label;
  TrainOptions options;
  options.class_names = {"non-edge", "smooth edge", "sharp edge"};
  const auto error = test::error_of([&] { train(kSmall, data.set(), options); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
  EXPECT_NE(std::string(error->what()).find("sharp edge"), std::string::npos);
}

TEST(Train, LeavesIgnoredSamplesOut) {
  Labelled data = rising_features(400, 1);
  const TrainResult wanted = train(kSmall, data.set(), {.epochs = 1});
  data.samples.resize(data.samples.size() + 12 * 50, NAN);
  data.labels.resize(data.labels.size() + 50, kIgnoredLabel);
  const TrainResult found = train(kSmall, data.set(), {.epochs = 1});
  EXPECT_EQ(found.best.network.parameters, wanted.best.network.parameters);
}

TEST(Train, RefusesWhatDoesNotFit) {
  Labelled data = rising_features(100, 1);
  EXPECT_ERROR(ErrorKind::kUsage, train(kSmall, data.set(), {.epochs = 0}));
  EXPECT_ERROR(ErrorKind::kUsage, train(kSmall, data.set(), {.learning_rate = -1.0}));
  EXPECT_ERROR(ErrorKind::kUsage, train(kSmall, data.set(), {.batch = 0}));
  for (const double balance : {-0.1, 1.5, static_cast<double>(NAN)}) {
    EXPECT_ERROR(ErrorKind::kUsage, train(kSmall, data.set(), {.balance = balance}));
  }
  EXPECT_ERROR(ErrorKind::kUsage, train({}, data.set(), {}));
  data.labels[7] = 3;
  EXPECT_ERROR(ErrorKind::kUsage, train(kSmall, data.set(), {}));
}

TEST(Train, TriesAllNetworks) {
  Labelled data = rising_features(1000, 1);
  for (const NetworkKind kind : {NetworkKind::kFc, NetworkKind::kCnn}) {
    Architecture architecture = kSmall;
    architecture.kind = kind;
    EXPECT_GT(share_right(train(architecture, data.set(), {.epochs = 10}).best, data), 0.98);
  }
}

}  // namespace
}  // namespace pcednet::nn
