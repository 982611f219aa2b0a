#include "pcednet/eval/scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "pcednet/eval/report.h"
#include "support/expect_error.h"

namespace pcednet::eval {
namespace {

const std::vector<std::uint8_t> kTruth = {0, 0, 0, 1, 1, 2, 2, 2, 255, 0};
const std::vector<std::uint8_t> kPredicted = {0, 1, 2, 1, 2, 2, 1, 0, 2, 255};

TEST(Scores, CountSharpAlone) {
  const ConfusionCounts counts = count_confusion(kTruth, kPredicted, Positive::kSharp);
  EXPECT_EQ(counts.tp, 1u);
  EXPECT_EQ(counts.fp, 2u);
  EXPECT_EQ(counts.fn, 2u);
  EXPECT_EQ(counts.tn, 4u);
}

TEST(Scores, CountBothEdgeClasses) {
  const ConfusionCounts counts = count_confusion(kTruth, kPredicted, Positive::kEdge);
  EXPECT_EQ(counts.tp, 4u);
  EXPECT_EQ(counts.fp, 2u);
  EXPECT_EQ(counts.fn, 1u);
  EXPECT_EQ(counts.tn, 2u);
}

TEST(Scores, CountBoundaryAloneOrAsNoEdge) {
  const std::vector<std::uint8_t> truth = {3, 3, 2, 0, 3, 255};
  const std::vector<std::uint8_t> predicted = {3, 2, 3, 3, 1, 3};
  EXPECT_EQ(count_confusion(truth, predicted, Positive::kBoundary),
            (ConfusionCounts{.tp = 1, .fp = 2, .tn = 0, .fn = 2}));
  EXPECT_EQ(count_confusion(truth, predicted, Positive::kSharp),
            (ConfusionCounts{.tp = 0, .fp = 1, .tn = 3, .fn = 1}));
  EXPECT_EQ(count_confusion(truth, predicted, Positive::kEdge),
            (ConfusionCounts{.tp = 0, .fp = 2, .tn = 2, .fn = 1}));
}

TEST(Scores, FollowTheirDefinitions) {
  const Scores scores = scores_of({.tp = 4, .fp = 2, .tn = 10, .fn = 1});
  EXPECT_DOUBLE_EQ(scores.precision, 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(scores.recall, 0.8);
  EXPECT_DOUBLE_EQ(scores.f1, 8.0 / 11.0);
  EXPECT_DOUBLE_EQ(scores.accuracy, 14.0 / 17.0);
  EXPECT_DOUBLE_EQ(scores.iou, 4.0 / 7.0);
  EXPECT_NEAR(scores.mcc, (4.0 * 10 - 2 * 1) / std::sqrt(6.0 * 5 * 12 * 11), 1e-15);
}

TEST(Scores, AreZeroWhereUndefinedAndExactForHugeCounts) {
  EXPECT_EQ(scores_of({}).mcc, 0.0);
  EXPECT_EQ(scores_of({.tn = 5}).precision, 0.0);
  const std::size_t many = 3'000'000'000;  // products of four such counts exceed 64 bits
  EXPECT_NEAR(scores_of({.tp = many, .fp = 0, .tn = many, .fn = 0}).mcc, 1.0, 1e-12);
}

TEST(Scores, RefusePredictionsOfAnotherSize) {
  const std::vector<std::uint8_t> too_few = {0, 1};
  EXPECT_ERROR(ErrorKind::kInsufficient, count_confusion(kTruth, too_few, Positive::kSharp));
}

TEST(EvaluationReport, GivesMedianAndPooledAsJson) {
  const std::vector<CloudScore> clouds = {{"a", {.tp = 1, .fp = 1, .tn = 8, .fn = 0}},
                                          {"b", {.tp = 9, .fp = 1, .tn = 0, .fn = 0}}};
  const auto json = nlohmann::json::parse(to_json(clouds));
  EXPECT_EQ(json["clouds"].size(), 2u);
  EXPECT_EQ(json["clouds"][0]["name"], "a");
  EXPECT_EQ(json["clouds"][0]["points"], 10);
  EXPECT_DOUBLE_EQ(json["median"]["precision"], 0.5 * (0.5 + 0.9));
  EXPECT_EQ(json["pooled"]["tp"], 10);
  EXPECT_DOUBLE_EQ(json["pooled"]["precision"], 10.0 / 12.0);
  for (const char* key : {"precision", "recall", "mcc", "f1", "accuracy", "iou"}) {
    EXPECT_TRUE(json["clouds"][1].contains(key)) << key;
    EXPECT_TRUE(json["median"].contains(key)) << key;
  }
}

TEST(EvaluationReport, ReplacesBytesOfNamesThatAreNotUtf8) {
  const auto json = nlohmann::json::parse(to_json(std::vector<CloudScore>{{"lat\xfcin", {}}}));
  EXPECT_EQ(json["clouds"][0]["name"], "lat\uFFFDin");
}

TEST(Calibration, IsTheMeanDifferenceInTheBins) {
  // Two bins: 0.25 said of four points, one of which is positive; 0.9 said of two, one of which is.
  const std::vector<std::uint8_t> truth = {2, 0, 0, 0, 2, 1, 255};
  const std::vector<float> p = {0.25f, 0.25f, 0.25f, 0.25f, 0.9f, 0.9f, 1.0f};
  Calibration calibration = {};
  add_calibration(truth, p, Positive::kSharp, calibration);
  EXPECT_EQ(calibration[2].points, 4u);
  EXPECT_EQ(calibration[9].points + calibration[8].points, 2u);
  EXPECT_NEAR(calibration_error(calibration), (0.0 * 4 + 0.4 * 2) / 6, 1e-6);
  Calibration edges = {};
  add_calibration(truth, p, Positive::kEdge, edges);
  EXPECT_NEAR(calibration_error(edges), (0.0 * 4 + 0.1 * 2) / 6, 1e-6);
  EXPECT_EQ(calibration_error({}), 0.0);
  EXPECT_ERROR(ErrorKind::kInsufficient,
               add_calibration(truth, {p.data(), 3}, Positive::kEdge, edges));
}

TEST(Scores, SayThatEdgesMarkedByOneAreNotCounted) {
  EXPECT_NE(none_is_positive(5, 0, Positive::kSharp).find("5 points are smooth-edge (1)"),
            std::string::npos);
  EXPECT_TRUE(none_is_positive(5, 1, Positive::kSharp).empty());
  EXPECT_TRUE(none_is_positive(0, 0, Positive::kSharp).empty());
  EXPECT_TRUE(none_is_positive(5, 0, Positive::kEdge).empty());
  EXPECT_TRUE(none_is_positive(5, 0, Positive::kBoundary).empty());
}

TEST(EvaluationReport, TakesTheMedianOfEachScoreByItself) {
  const std::vector<CloudScore> clouds = {{"a", {.tp = 10, .fp = 3, .tn = 80, .fn = 7}},
                                          {"b", {.tp = 20, .fp = 9, .tn = 60, .fn = 1}},
                                          {"c", {.tp = 5, .fp = 1, .tn = 30, .fn = 9}}};
  const auto json = nlohmann::json::parse(to_json(clouds));
  std::set<double> medians;
  for (const char* key : {"precision", "recall", "mcc", "f1", "accuracy", "iou"}) {
    std::vector<double> values;
    for (const auto& row : json["clouds"]) values.push_back(row[key]);
    std::sort(values.begin(), values.end());
    EXPECT_EQ(json["median"][key], values[1]) << key;
    medians.insert(values[1]);
  }
  EXPECT_EQ(medians.size(), 6u) << "equal scores could be exchanged unseen";
}

TEST(Calibration, HasABinForEveryProbability) {
  const std::vector<std::uint8_t> truth = {2, 0, 2, 0, 0};
  const std::vector<float> p = {1.0f, 0.0f, 0.95f, -0.5f, 7.0f};
  Calibration calibration = {};
  add_calibration(truth, p, Positive::kSharp, calibration);
  EXPECT_EQ(calibration[0].points, 2u);
  EXPECT_EQ(calibration[9].points, 3u);
  EXPECT_EQ(calibration[9].positive, 2u);
  EXPECT_NEAR(calibration[9].sum_probability, 2.95, 1e-6);
}

}  // namespace
}  // namespace pcednet::eval
