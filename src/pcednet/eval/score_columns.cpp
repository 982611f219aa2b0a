#include "pcednet/eval/score_columns.h"

#include <fmt/format.h>

#include <algorithm>

namespace pcednet::eval {
namespace {

std::size_t width_of(const ScoreColumn& column) {
  return std::max<std::size_t>(7, column.heading.size());
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

}  // namespace pcednet::eval
