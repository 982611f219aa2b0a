#include "pcednet/eval/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/counted.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"
#include "pcednet/core/median.h"

namespace pcednet::eval {
namespace {

std::size_t width_of(const ScoreColumn& column) {
  return std::max<std::size_t>(7, column.heading.size());
}

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

/// Precision, recall, F1 and IoU: the others are of two classes.
constexpr std::array kClassColumns = {kScoreColumns[0], kScoreColumns[1], kScoreColumns[3],
                                      kScoreColumns[5]};

std::size_t points_of(const ConfusionCounts& counts) {
  return counts.tp + counts.fn;
}

double share_of_right(const ClassReport& report) {
  return report.points == 0
             ? 0.0
             : static_cast<double>(report.right) / static_cast<double>(report.points);
}

/// The macro average of the scores, over the classes that occur in the truth.
Scores mean_scores(const ClassReport& report) {
  Scores mean;
  double classes = 0;
  for (const ConfusionCounts& counts : report.counts) classes += points_of(counts) > 0 ? 1 : 0;
  for (const ConfusionCounts& counts : report.counts) {
    if (points_of(counts) == 0) continue;
    const Scores its = scores_of(counts);
    for (const ScoreColumn& column : kClassColumns) {
      mean.*column.score += its.*column.score / classes;
    }
  }
  return mean;
}

}  // namespace

std::string heading_line(const std::string& name, std::span<const ScoreColumn> columns) {
  std::string line = fmt::format("{:<24} {:>10}", name, "points");
  for (const ScoreColumn& column : columns) {
    line += fmt::format(" {:>{}}", column.heading, width_of(column));
  }
  return line + "\n";
}

std::string score_line(const std::string& name, const std::string& points, const Scores& scores,
                       std::span<const ScoreColumn> columns) {
  std::string line = fmt::format("{:<24} {:>10}", name, points);
  for (const ScoreColumn& column : columns) {
    line += fmt::format(" {:>{}.3f}", scores.*column.score, width_of(column));
  }
  return line + "\n";
}

void add_calibration(std::span<const std::uint8_t> truth, std::span<const float> probabilities,
                     Positive positive, Calibration& calibration) {
  if (truth.size() != probabilities.size()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{} probabilities for {} labelled points",
                                                      probabilities.size(), truth.size()));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == kUnlabelled) continue;
    const double p = std::clamp(static_cast<double>(probabilities[i]), 0.0, 1.0);
    const auto bins = static_cast<double>(calibration.size());
    CalibrationBin& bin =
        calibration[std::min(calibration.size() - 1, static_cast<std::size_t>(p * bins))];
    ++bin.points;
    bin.sum_probability += p;
    bin.positive += is_positive(truth[i], positive);
  }
}

double calibration_error(const Calibration& calibration) {
  double difference = 0.0;
  std::size_t points = 0;
  for (const CalibrationBin& bin : calibration) {
    difference += std::abs(bin.sum_probability - static_cast<double>(bin.positive));
    points += bin.points;
  }
  return points == 0 ? 0.0 : difference / static_cast<double>(points);
}

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

void add_cloud(std::span<const std::uint8_t> truth, std::span<const std::uint8_t> predicted,
               ClassReport& report) {
  std::vector<std::uint8_t> known(truth.begin(), truth.end());
  for (std::uint8_t& id : known) {
    if (id >= report.table.size()) id = kUnlabelled;
  }
  report.counts.resize(report.table.size());
  for (std::size_t id = 0; id < report.counts.size(); ++id) {
    const auto its = count_confusion(known, predicted, static_cast<std::uint8_t>(id));
    report.counts[id] += its;
    report.right += its.tp;
    report.points += points_of(its);
  }
  ++report.clouds;
}

std::string to_json(const ClassReport& report) {
  OrderedJson json;
  json["classes"] = OrderedJson::array();
  for (std::size_t id = 0; id < report.counts.size(); ++id) {
    OrderedJson row = {
        {"id", id}, {"name", report.table[id].name}, {"points", points_of(report.counts[id])}};
    put(row, scores_of(report.counts[id]), kClassColumns);
    json["classes"].push_back(row);
  }
  put(json["mean"], mean_scores(report), kClassColumns);
  json["accuracy"] = share_of_right(report);
  json["points"] = report.points;
  json["clouds"] = report.clouds;
  return to_text(json, 2) + "\n";
}

std::string to_table(const ClassReport& report) {
  std::string table = heading_line("class", kClassColumns);
  for (std::size_t id = 0; id < report.counts.size(); ++id) {
    table += score_line(report.table[id].name, std::to_string(points_of(report.counts[id])),
                        scores_of(report.counts[id]), kClassColumns);
  }
  table += score_line("mean", std::to_string(report.points), mean_scores(report), kClassColumns);
  return table + fmt::format("accuracy {:.3f}, {}\n", share_of_right(report),
                             counted(report.clouds, "cloud"));
}

}  // namespace pcednet::eval
