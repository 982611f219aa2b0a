#include "pcednet/eval/predictions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/labels.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/npy.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::eval {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostColumns = kUnlabelled;
constexpr double kRounding = 1e-5;  ///< of coordinates, of the diagonal of the cloud

/// Files with classes only come before point files.
std::vector<std::string_view> extensions_of_predictions() {
  std::vector<std::string_view> extensions = {".u8", ".txt", ".csv", ".lbl", ".seg", ".npy"};
  for (const formats::Format& format : formats::all_formats()) {
    extensions.insert(extensions.end(), format.extensions.begin(), format.extensions.end());
  }
  return extensions;
}

Error misfit(const fs::path& path, const std::string& what, std::size_t points) {
  return Error(ErrorKind::kInsufficient,
               fmt::format("{}: {}, but the cloud has {} points", path.string(), what, points));
}

Error no_class(const fs::path& path, const std::string& place, double value,
               const ClassTable& table) {
  return Error(
      ErrorKind::kInsufficient,
      fmt::format("{}: {} is {}, no class: there are 0 to {}, and 255 or -1 for unlabelled",
                  path.string(), place, value, table.size() - 1));
}

/// The class of a row: its number, or the column of its largest score.
std::uint8_t class_of_row(const fs::path& path, std::size_t row, std::span<const double> values,
                          const ClassTable& table) {
  const auto place = fmt::format("row {}", row);
  for (const double value : values) {
    if (std::isnan(value)) throw no_class(path, place, value, table);
  }
  const bool scored = values.size() > 1;
  const auto best = std::max_element(values.begin(), values.end());
  const double number = scored ? static_cast<double>(best - values.begin()) : values[0];
  const auto label = io::to_label(number);
  if (!label || (*label >= table.size() && (scored || *label != kUnlabelled))) {
    throw no_class(path, place, number, table);
  }
  return *label;
}

std::vector<std::uint8_t> classes_of_array(const fs::path& path, const io::NpyArray& array,
                                           std::size_t points, const ClassTable& table) {
  const std::size_t rows = array.shape.empty() ? 0 : array.shape[0];
  const std::size_t columns = array.shape.size() < 2 ? 1 : array.shape[1];
  if (rows != points || array.shape.size() > 2 || columns == 0) {
    throw misfit(path, fmt::format("an array of {} values in {} rows", array.values.size(), rows),
                 points);
  }
  if (columns > kMostColumns) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: scores of {} classes; at most {} can be told apart", path.string(),
                            columns, kMostColumns));
  }
  std::vector<std::uint8_t> classes(points);
  for (std::size_t i = 0; i < points; ++i) {
    classes[i] =
        class_of_row(path, i, std::span(array.values).subspan(i * columns, columns), table);
  }
  // Two columns are scores of non-edge and edge; of bool, true is an edge.
  if (!has_own_classes(table) && (columns == 2 || array.is_bool)) {
    std::replace(classes.begin(), classes.end(), kSmoothEdge, kSharpEdge);
  }
  return classes;
}

/// Coordinates may be rounded by this.
double rounding_of(std::span<const Vec3> positions) {
  return kRounding * bounding_box(positions).diagonal();
}

/// Of these points.
bool are_few(std::size_t count, std::size_t points) {
  return count * 100 <= points;
}

bool are_in_order(std::span<const Vec3> positions, std::span<const Vec3> others) {
  const double rounding = rounding_of(positions);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    moved += (positions[i] - others[i]).norm() > rounding;
  }
  return are_few(moved, positions.size());
}

/// Whether nearly all positions are among those of the tree. Those of another system are not.
bool are_among(std::span<const Vec3> positions, const spatial::KdTree& tree) {
  const double rounding = rounding_of(positions);
  std::vector<spatial::Neighbour> found;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < positions.size() && are_few(missing, positions.size()); ++i) {
    if (!positions[i].allFinite()) continue;
    tree.nearest(positions[i], 1, found);
    missing += found.empty() || std::sqrt(found[0].sq_distance) > rounding;
  }
  return are_few(missing, positions.size());
}

std::vector<std::uint8_t> labels_of_nearest(std::span<const Vec3> positions,
                                            const spatial::KdTree& others,
                                            const std::vector<std::uint8_t>& labels) {
  std::vector<std::uint8_t> classes(positions.size(), kUnlabelled);
  parallel_blocks(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      if (!positions[i].allFinite()) continue;
      others.nearest(positions[i], 1, found);
      if (!found.empty()) classes[i] = labels[found[0].index];
    }
  });
  return classes;
}

std::vector<std::uint8_t> nearest_to_edge_points(std::span<const Vec3> positions,
                                                 const PointCloud& edge_points) {
  const spatial::KdTree tree(positions);
  std::vector<std::uint8_t> classes(positions.size(), kNonEdge);
  std::vector<spatial::Neighbour> found;
  for (const Vec3& point : edge_points.positions) {
    if (!point.allFinite()) continue;
    tree.nearest(point, 1, found);
    if (!found.empty()) classes[found[0].index] = kSharpEdge;
  }
  return classes;
}

}  // namespace

fs::path find_predictions(const fs::path& folder, const std::string& stem, const fs::path& cloud) {
  const auto extensions = extensions_of_predictions();
  for (const char* suffix : {"", "_edges", "_output"}) {
    for (const std::string_view extension : extensions) {
      fs::path file = folder / fmt::format("{}{}{}", stem, suffix, extension);
      std::error_code error;
      if (!fs::is_regular_file(file, error)) continue;
      if (!fs::equivalent(file, cloud, error)) return file;
    }
  }
  return {};
}

Predictions read_predictions(const fs::path& path, std::span<const Vec3> positions,
                             const ClassTable& table) {
  if (io::extension_of(path) == ".npy") {
    return {classes_of_array(path, io::read_npy(path), positions.size(), table), {}};
  }
  if (auto classes = formats::read_bare_labels(path, table.size())) {
    if (classes->size() == positions.size()) return {*std::move(classes), {}};
    throw misfit(path, fmt::format("{} classes", classes->size()), positions.size());
  }
  const PointCloud others = formats::read_cloud(path).cloud;
  auto labels = formats::labels_of(others, path);
  std::string from;
  if (labels.empty() && has_edges(table)) {
    if (auto column = formats::edge_column_of(others)) {
      labels = std::move(column->classes);
      from = fmt::format("labels from its column {}", column->column);
    }
  }
  if (labels.empty() && !has_edges(table)) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no labels; points without any are read as edge points, and "
                            "the classes are {}",
                            path.string(), names_of(table)));
  }
  if (labels.empty()) {
    return {nearest_to_edge_points(positions, others),
            fmt::format("{} points without labels: read as edge points", others.size())};
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < table.size() || labels[i] == kUnlabelled) continue;
    throw no_class(path, fmt::format("point {}", i), labels[i], table);
  }
  const bool is_as_large = labels.size() == positions.size();
  if (is_as_large && are_in_order(positions, others.positions)) return {std::move(labels), from};
  const spatial::KdTree tree(others.positions);
  if (is_as_large && !are_among(positions, tree)) return {std::move(labels), from};
  const std::string why = is_as_large
                              ? "the points are in another order"
                              : fmt::format("{} points for {}", others.size(), positions.size());
  return {labels_of_nearest(positions, tree, labels),
          fmt::format("{}{}{}: each takes the label of the nearest", from, from.empty() ? "" : "; ",
                      why)};
}

}  // namespace pcednet::eval
