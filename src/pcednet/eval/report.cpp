#include "pcednet/eval/report.h"

#include <fmt/format.h>

#include "pcednet/core/json.h"
#include "pcednet/core/median.h"

namespace pcednet::eval {
namespace {

void put(OrderedJson& row, const ConfusionCounts& counts) {
  row["points"] = counts.total();
  row["tp"] = counts.tp;
  row["fp"] = counts.fp;
  row["tn"] = counts.tn;
  row["fn"] = counts.fn;
}

void put(OrderedJson& row, const Scores& scores) {
  row["precision"] = scores.precision;
  row["recall"] = scores.recall;
  row["mcc"] = scores.mcc;
  row["f1"] = scores.f1;
  row["accuracy"] = scores.accuracy;
  row["iou"] = scores.iou;
}

std::string table_row(const std::string& name, const std::string& points, const Scores& s) {
  return fmt::format("{:<24} {:>10} {:>9.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>8.3f} {:>7.3f}\n", name,
                     points, s.precision, s.recall, s.mcc, s.f1, s.accuracy, s.iou);
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
  const auto over_clouds = [&](double Scores::*score) {
    std::vector<double> values;
    for (const CloudScore& cloud : clouds) values.push_back(scores_of(cloud.counts).*score);
    return median(std::move(values));
  };
  return {over_clouds(&Scores::precision), over_clouds(&Scores::recall),
          over_clouds(&Scores::mcc),       over_clouds(&Scores::f1),
          over_clouds(&Scores::accuracy),  over_clouds(&Scores::iou)};
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
  return to_text(report, 2) + "\n";
}

std::string to_table(const std::vector<CloudScore>& clouds) {
  std::string table = fmt::format("{:<24} {:>10} {:>9} {:>7} {:>7} {:>7} {:>8} {:>7}\n", "cloud",
                                  "points", "precision", "recall", "MCC", "F1", "accuracy", "IoU");
  for (const CloudScore& cloud : clouds) {
    table += table_row(cloud.name, std::to_string(cloud.counts.total()), scores_of(cloud.counts));
  }
  const ConfusionCounts pooled = pooled_counts(clouds);
  table += table_row("median", "", median_scores(clouds));
  table += table_row("pooled", std::to_string(pooled.total()), scores_of(pooled));
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
