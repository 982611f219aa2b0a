#include "pcednet/eval/class_report.h"

#include <fmt/format.h>

#include "pcednet/core/json.h"

namespace pcednet::eval {
namespace {

std::size_t points_of(const ConfusionCounts& counts) {
  return counts.tp + counts.fn;
}

OrderedJson class_scores_json(const Scores& scores) {
  return {{"precision", scores.precision},
          {"recall", scores.recall},
          {"f1", scores.f1},
          {"iou", scores.iou}};
}

std::string class_row(const std::string& name, const std::string& points, const Scores& s) {
  return fmt::format("{:<24} {:>10} {:>9.3f} {:>7.3f} {:>7.3f} {:>7.3f}\n", name, points,
                     s.precision, s.recall, s.f1, s.iou);
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
    for (double Scores::*score : {&Scores::precision, &Scores::recall, &Scores::f1, &Scores::iou}) {
      mean.*score += its.*score / classes;
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
    row.update(class_scores_json(scores_of(report.counts[id])));
    json["classes"].push_back(row);
  }
  json["mean"] = class_scores_json(mean_scores(report));
  json["accuracy"] = share_of_right(report);
  json["points"] = report.points;
  json["clouds"] = report.clouds;
  return to_text(json, 2) + "\n";
}

std::string to_table(const ClassReport& report) {
  std::string table = fmt::format("{:<24} {:>10} {:>9} {:>7} {:>7} {:>7}\n", "class", "points",
                                  "precision", "recall", "F1", "IoU");
  for (std::size_t id = 0; id < report.counts.size(); ++id) {
    table += class_row(report.table[id].name, std::to_string(points_of(report.counts[id])),
                       scores_of(report.counts[id]));
  }
  table += class_row("mean", std::to_string(report.points), mean_scores(report));
  return table + fmt::format("accuracy {:.3f}, {} cloud{}\n", share_of_right(report), report.clouds,
                             report.clouds == 1 ? "" : "s");
}

}  // namespace pcednet::eval
