#pragma once

#include <string>
#include <vector>

#include "pcednet/eval/calibration.h"
#include "pcednet/eval/scores.h"

namespace pcednet::eval {

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

}  // namespace pcednet::eval
