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

/// The median over the clouds of each score by itself (of an even number, the mean of the middle
/// two). All zero without clouds.
Scores median_scores(const std::vector<CloudScore>& clouds);

/// The summed counts, whose scores are the pooled ones.
ConfusionCounts pooled_counts(const std::vector<CloudScore>& clouds);

/// {"clouds":[{"name","points","tp",...,"iou"}],"median":{...},"pooled":{...}}, indented, with a
/// final newline; with `calibration` also {"calibration":{"error","bins":[{"points","probability",
/// "positive"}]}}, of which the last two are means.
std::string to_json(const std::vector<CloudScore>& clouds,
                    const Calibration* calibration = nullptr);

/// A text table: a row per cloud, then median and pooled.
std::string to_table(const std::vector<CloudScore>& clouds);

/// A text table: a row per bin that has points, then the error.
std::string to_table(const Calibration& calibration);

}  // namespace pcednet::eval
