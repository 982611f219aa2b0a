#include "pcednet/eval/report.h"

#include <fmt/format.h>

#include "pcednet/core/json.h"
#include "pcednet/core/median.h"
#include "pcednet/eval/score_columns.h"

namespace pcednet::eval {
namespace {

void put(OrderedJson& row, const ConfusionCounts& counts) {
  row["points"] = counts.total();
  row["tp"] = counts.tp;
  row["fp"] = counts.fp;
  row["tn"] = counts.tn;
  row["fn"] = counts.fn;
}

struct BinMeans {
  double probability = 0.0, positive = 0.0;
};

BinMeans means_of(const CalibrationBin& bin) {
  if (bin.points == 0) return {};
  const auto points = static_cast<double>(bin.points);
  return {bin.sum_probability / points, static_cast<double>(bin.positive) / points};
}

}  // namespace

Scores median_scores(const std::vector<CloudScore>& clouds) {
  Scores medians;
  for (const ScoreColumn& column : kScoreColumns) {
    std::vector<double> values;
    for (const CloudScore& cloud : clouds) {
      values.push_back(scores_of(cloud.counts).*column.score);
    }
    medians.*column.score = median(std::move(values));
  }
  return medians;
}

ConfusionCounts pooled_counts(const std::vector<CloudScore>& clouds) {
  ConfusionCounts pooled;
  for (const CloudScore& cloud : clouds) pooled += cloud.counts;
  return pooled;
}

std::string to_json(const std::vector<CloudScore>& clouds, const Calibration* calibration) {
  OrderedJson report;
  report["clouds"] = OrderedJson::array();
  for (const CloudScore& cloud : clouds) {
    OrderedJson row;
    row["name"] = cloud.name;
    put(row, cloud.counts);
    put(row, scores_of(cloud.counts));
    report["clouds"].push_back(row);
  }
  put(report["median"] = OrderedJson::object(), median_scores(clouds));
  const ConfusionCounts pooled = pooled_counts(clouds);
  put(report["pooled"] = OrderedJson::object(), pooled);
  put(report["pooled"], scores_of(pooled));
  if (calibration) {
    OrderedJson& json = report["calibration"];
    json["error"] = calibration_error(*calibration);
    json["bins"] = OrderedJson::array();
    for (const CalibrationBin& bin : *calibration) {
      const auto [probability, positive] = means_of(bin);
      json["bins"].push_back(
          {{"points", bin.points}, {"probability", probability}, {"positive", positive}});
    }
  }
  return to_text(report, 2, NotUtf8::kReplace) + "\n";
}

std::string to_table(const std::vector<CloudScore>& clouds) {
  std::string table = heading_line("cloud");
  for (const CloudScore& cloud : clouds) {
    table += score_line(cloud.name, std::to_string(cloud.counts.total()), scores_of(cloud.counts));
  }
  const ConfusionCounts pooled = pooled_counts(clouds);
  table += score_line("median", "", median_scores(clouds));
  table += score_line("pooled", std::to_string(pooled.total()), scores_of(pooled));
  return table;
}

std::string to_table(const Calibration& calibration) {
  std::string table = fmt::format("{:>11} {:>10} {:>8}\n", "probability", "points", "positive");
  for (const CalibrationBin& bin : calibration) {
    if (bin.points == 0) continue;
    const auto [probability, positive] = means_of(bin);
    table += fmt::format("{:>11.3f} {:>10} {:>8.3f}\n", probability, bin.points, positive);
  }
  return table + fmt::format("calibration error {:.4f}\n", calibration_error(calibration));
}

}  // namespace pcednet::eval
