#include <fmt/format.h>

#include <array>
#include <cmath>

#include "pcednet/core/json.h"
#include "pcednet/core/median.h"
#include "pcednet/eval/line_scores.h"

namespace pcednet::eval {
namespace {

struct Column {
  const char* heading;
  const char* key;
  double LineScores::*score;
  int digits;
};

constexpr std::array<Column, 9> kColumns = {
    {{"CD", "cd", &LineScores::chamfer, 4},
     {"HD", "hd", &LineScores::hausdorff, 3},
     {"P .01", "precision_01", &LineScores::fine_precision, 3},
     {"R .01", "recall_01", &LineScores::fine_recall, 3},
     {"P .02", "precision_02", &LineScores::precision, 3},
     {"R .02", "recall_02", &LineScores::recall, 3},
     {"found", "found", &LineScores::found, 3},
     {"pieces", "pieces", &LineScores::pieces, 2},
     {"corners", "corners", &LineScores::corners, 3}}};

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// A score over all clouds, NaN if none has it.
LineScores over(const std::vector<NamedLineScores>& clouds,
                double (*summary)(const std::vector<double>&)) {
  LineScores result;
  for (const Column& column : kColumns) {
    std::vector<double> values;
    for (const NamedLineScores& cloud : clouds) {
      const double value = cloud.scores.*column.score;
      if (!std::isnan(value)) values.push_back(value);
    }
    result.*column.score = values.empty() ? std::nan("") : summary(values);
  }
  return result;
}

double middle(const std::vector<double>& values) {
  return median(values);
}

void put(OrderedJson& row, const LineScores& scores) {
  for (const Column& column : kColumns) {
    const double value = scores.*column.score;
    row[column.key] = std::isnan(value) ? OrderedJson(nullptr) : OrderedJson(value);
  }
}

std::string table_row(const std::string& name, const std::string& lines, const std::string& curves,
                      const LineScores& scores) {
  std::string row = fmt::format("{:<24} {:>6} {:>6}", name, lines, curves);
  for (const Column& column : kColumns) {
    const double value = scores.*column.score;
    row += std::isnan(value) ? fmt::format(" {:>7}", "-")
                             : fmt::format(" {:>7.{}f}", value, column.digits);
  }
  return row + "\n";
}

}  // namespace

std::string to_json(const std::vector<NamedLineScores>& clouds) {
  OrderedJson report;
  report["clouds"] = OrderedJson::array();
  for (const auto& [name, scores] : clouds) {
    OrderedJson row;
    row["name"] = name;
    row["lines"] = scores.lines;
    row["true_curves"] = scores.true_curves;
    put(row, scores);
    report["clouds"].push_back(row);
  }
  put(report["median"] = OrderedJson::object(), over(clouds, middle));
  put(report["mean"] = OrderedJson::object(), over(clouds, mean));
  return to_text(report, 2, NotUtf8::kReplace) + "\n";
}

std::string to_table(const std::vector<NamedLineScores>& clouds) {
  std::string table = fmt::format("{:<24} {:>6} {:>6}", "cloud", "lines", "true");
  for (const Column& column : kColumns) table += fmt::format(" {:>7}", column.heading);
  table += "\n";
  for (const auto& [name, scores] : clouds) {
    table +=
        table_row(name, std::to_string(scores.lines), std::to_string(scores.true_curves), scores);
  }
  table += table_row("median", "", "", over(clouds, middle));
  return table + table_row("mean", "", "", over(clouds, mean));
}

}  // namespace pcednet::eval
