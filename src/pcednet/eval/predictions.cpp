#include "pcednet/eval/predictions.h"

#include <fmt/format.h>

#include <algorithm>

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

constexpr std::size_t kMostClasses = kUnlabelled;

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

std::vector<std::uint8_t> classes_of_array(const fs::path& path, const io::NpyArray& array,
                                           std::size_t points) {
  const std::size_t rows = array.shape.empty() ? 0 : array.shape[0];
  const std::size_t columns = array.shape.size() < 2 ? 1 : array.shape[1];
  if (rows != points || array.shape.size() > 2 || columns == 0) {
    throw misfit(path, fmt::format("an array of {} values in {} rows", array.values.size(), rows),
                 points);
  }
  if (columns > kMostClasses) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: scores of {} classes; at most {} can be told apart", path.string(),
                            columns, kMostClasses));
  }
  std::vector<std::uint8_t> classes(points);
  for (std::size_t i = 0; i < points; ++i) {
    const auto row = array.values.begin() + static_cast<std::ptrdiff_t>(i * columns);
    const auto best = std::max_element(row, row + static_cast<std::ptrdiff_t>(columns));
    const auto label =
        columns > 1 ? static_cast<std::uint8_t>(best - row) : io::to_label(array.values[i]);
    if (!label) {
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("{}: row {} is {}, no class", path.string(), i, array.values[i]));
    }
    classes[i] = *label;
  }
  // Two columns are scores of non-edge and edge; of bool, true is an edge.
  if (columns == 2 || array.is_bool) {
    std::replace(classes.begin(), classes.end(), kSmoothEdge, kSharpEdge);
  }
  return classes;
}

std::vector<std::uint8_t> labels_of_nearest(std::span<const Vec3> positions,
                                            const PointCloud& others,
                                            const std::vector<std::uint8_t>& labels) {
  const spatial::KdTree tree(others.positions);
  std::vector<std::uint8_t> classes(positions.size(), kUnlabelled);
  parallel_blocks(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      if (!positions[i].allFinite()) continue;
      tree.nearest(positions[i], 1, found);
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

Predictions read_predictions(const fs::path& path, std::span<const Vec3> positions) {
  if (io::extension_of(path) == ".npy") {
    return {classes_of_array(path, io::read_npy(path), positions.size()), {}};
  }
  if (auto classes = formats::read_bare_labels(path)) {
    if (classes->size() == positions.size()) return {*std::move(classes), {}};
    throw misfit(path, fmt::format("{} classes", classes->size()), positions.size());
  }
  const PointCloud others = formats::read_cloud(path).cloud;
  auto labels = formats::labels_of(others, path);
  if (labels.empty()) {
    return {nearest_to_edge_points(positions, others),
            fmt::format("{} points without labels: read as edge points", others.size())};
  }
  if (labels.size() == positions.size()) return {std::move(labels), {}};
  return {labels_of_nearest(positions, others, labels),
          fmt::format("{} points for {}: each takes the label of the nearest", others.size(),
                      positions.size())};
}

}  // namespace pcednet::eval
