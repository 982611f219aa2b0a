#include "pcednet/eval/class_report.h"

#include <fmt/format.h>

#include <array>

#include "pcednet/core/json.h"
#include "pcednet/eval/score_columns.h"

namespace pcednet::eval {
namespace {

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
  return table + fmt::format("accuracy {:.3f}, {} cloud{}\n", share_of_right(report), report.clouds,
                             report.clouds == 1 ? "" : "s");
}

}  // namespace pcednet::eval
