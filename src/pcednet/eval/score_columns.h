#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

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

}  // namespace pcednet::eval
