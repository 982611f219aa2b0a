#include "pcednet/io/xyz_guess.h"

#include <fmt/format.h>

#include <cmath>

namespace pcednet::io {
namespace {

/// Whether `holds(row)` is true in all rows, of which there is at least one.
template <typename Predicate>
bool in_all_rows(const NumberTable& table, Predicate&& holds) {
  for (std::size_t r = 0; r < table.rows(); ++r) {
    if (!holds(table.row(r))) return false;
  }
  return table.rows() > 0;
}

bool are_normals(const NumberTable& table, std::size_t first) {
  std::size_t unit = 0;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    if (looks_like_normal(table.row(r) + first)) ++unit;
  }
  return unit > 0 && 10 * unit >= 9 * table.rows();
}

bool are_colours(const NumberTable& table, std::size_t first) {
  return in_all_rows(table, [&](const double* row) {
    for (std::size_t c = first; c < first + 3; ++c) {
      if (!(row[c] >= 0.0 && row[c] <= 255.0 && row[c] == std::floor(row[c]))) return false;
    }
    return true;
  });
}

bool is_label(const NumberTable& table, std::size_t column) {
  return in_all_rows(table, [&](const double* row) {
    const double value = row[column];
    return value == 0.0 || value == 1.0 || value == 2.0 || value == 255.0;
  });
}

}  // namespace

bool looks_like_normal(const double* n) {
  const double length = std::hypot(n[0], n[1], n[2]);
  return length > 0.9 && length < 1.1;
}

bool counts_rows(const NumberTable& table) {
  double next = table.rows() > 3 ? std::floor(*table.row(0)) : NAN;
  return in_all_rows(table, [&](const double* row) { return row[0] == next++; });
}

std::vector<std::string> guess_column_names(const NumberTable& table, TextKind kind) {
  std::vector<std::string> names = {"x", "y", "z"};
  bool has_normals = false, has_colours = false;
  while (names.size() < table.columns()) {
    const std::size_t next = names.size();
    const std::size_t left = table.columns() - next;
    // x y z intensity r g b, the usual .pts: four columns of which three are colours either way.
    const bool is_counted = kind == TextKind::kCountedPts;
    const bool may_be_label = !is_counted && is_label(table, table.columns() - 1);
    const bool scalar_first = left == 4 && are_colours(table, next + 1) && !may_be_label;
    const bool is_alone = left == 1 && !may_be_label;
    if (kind != TextKind::kAny && next == 3 && (scalar_first || is_alone)) {
      names.emplace_back("intensity");
    } else if (left >= 3 && !has_normals && are_normals(table, next)) {
      names.insert(names.end(), {"nx", "ny", "nz"});
      has_normals = true;
    } else if (left >= 3 && !has_colours && !scalar_first && are_colours(table, next)) {
      names.insert(names.end(), {"red", "green", "blue"});
      has_colours = true;
    } else if (left == 1 && is_label(table, next)) {
      names.emplace_back("label");
    } else {
      names.push_back(fmt::format("scalar_{}", next + 1));
    }
  }
  return names;
}

}  // namespace pcednet::io
