#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/eval/scores.h"

namespace pcednet::eval {

/// A score by its name in files and its heading in tables.
struct ScoreColumn {
  const char* key;
  std::string_view heading;
  double Scores::*score;
};

inline constexpr std::array<ScoreColumn, 6> kScoreColumns = {
    {{"precision", "precision", &Scores::precision},
     {"recall", "recall", &Scores::recall},
     {"mcc", "MCC", &Scores::mcc},
     {"f1", "F1", &Scores::f1},
     {"accuracy", "accuracy", &Scores::accuracy},
     {"iou", "IoU", &Scores::iou}}};

/// Sets the members of a JSON object, or of a dictionary.
template <typename Row>
void put(Row& row, const Scores& scores, std::span<const ScoreColumn> columns = kScoreColumns) {
  for (const ScoreColumn& column : columns) row[column.key] = scores.*column.score;
}

/// The lines of a text table: a name, a number of points, and the scores.
std::string heading_line(const std::string& name,
                         std::span<const ScoreColumn> columns = kScoreColumns);
std::string score_line(const std::string& name, const std::string& points, const Scores& scores,
                       std::span<const ScoreColumn> columns = kScoreColumns);

/// The points whose probability of the positive classes lies in one tenth of [0, 1].
struct CalibrationBin {
  std::size_t points = 0;
  double sum_probability = 0.0;
  std::size_t positive = 0;  ///< with a positive true class
};

/// A reliability diagram: eight in ten points with probability 0.8 should be edges.
using Calibration = std::array<CalibrationBin, 10>;

/// Adds the points of a cloud. `probabilities` are those of the positive classes; a point
/// whose truth is kUnlabelled is left out. Throws Error(kInsufficient) if the sizes differ.
void add_calibration(std::span<const std::uint8_t> truth, std::span<const float> probabilities,
                     Positive positive, Calibration& calibration);

/// The expected calibration error: the mean over the points of the difference, in their bin,
/// between the mean probability and the share that is positive. 0 without points.
double calibration_error(const Calibration& calibration);

/// One evaluated cloud.
struct CloudScore {
  std::string name;
  ConfusionCounts counts;
};

/// The median over the clouds of each score separately (the mean of the middle two for an even
/// number). All zero without clouds.
Scores median_scores(const std::vector<CloudScore>& clouds);

/// The summed counts; their scores are the pooled scores.
ConfusionCounts pooled_counts(const std::vector<CloudScore>& clouds);

/// {"clouds":[{"name","points","tp",...,"iou"}],"median":{...},"pooled":{...}}, indented, with a
/// final newline; with `calibration` also {"calibration":{"error","bins":[{"points","probability",
/// "positive"}]}}, of which the last two are means. Bytes of names that are not UTF-8 become
/// U+FFFD.
std::string to_json(const std::vector<CloudScore>& clouds,
                    const Calibration* calibration = nullptr);

/// A text table: a row per cloud, then median and pooled.
std::string to_table(const std::vector<CloudScore>& clouds);

/// A text table: a row per bin that has points, then the error.
std::string to_table(const Calibration& calibration);

/// The confusion counts of every class against all others, for any classes, summed over clouds.
struct ClassReport {
  ClassTable table = {};
  std::vector<ConfusionCounts> counts = {};  ///< by class
  std::size_t clouds = 0, points = 0, right = 0;
};

/// Adds a cloud; both spans have a class per point. A point whose truth is not a class of the table
/// is left out. Throws Error(kInsufficient) if the sizes differ.
void add_cloud(std::span<const std::uint8_t> truth, std::span<const std::uint8_t> predicted,
               ClassReport& report);

/// {"classes":[{"id","name","points","precision","recall","f1","iou"}],"mean":{...},"accuracy",
/// "points","clouds"}, indented, with a final newline. "mean" is the macro average over the classes
/// that occur in the truth.
std::string to_json(const ClassReport& report);

/// A text table: a row per class, then their mean and the accuracy.
std::string to_table(const ClassReport& report);

}  // namespace pcednet::eval
