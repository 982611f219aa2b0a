#include "workbench/truth/read_labelled.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/formats/labels.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/text_scan.h"
#include "workbench/truth/abc_features.h"
#include "workbench/truth/colour_labels.h"

namespace pcednet::truth {

namespace {

bool is_result(const PointCloud& cloud) {
  return std::any_of(cloud.comments.begin(), cloud.comments.end(), [](const std::string& comment) {
    return comment.starts_with(detect::kModelComment);
  });
}

/// The labels in a column of a result; none if no point has one.
std::vector<std::uint8_t> labels_in(const PointCloud& cloud, const char* column) {
  const Attribute* attribute = find_attribute(cloud, column);
  if (!attribute || attribute->type != ScalarType::kUint8) return {};
  std::vector<std::uint8_t> labels(cloud.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    labels[i] = static_cast<std::uint8_t>(attribute->value(i));
  }
  if (!formats::have_labels(labels)) labels.clear();
  return labels;
}

/// The labels of a result are no truth: those that were painted, or those of its input, are.
void take_truth_of_result(io::LoadedCloud& loaded) {
  for (const char* column : {"scalar_painted_label", "scalar_input_label"}) {
    auto labels = labels_in(loaded.cloud, column);
    if (labels.empty()) continue;
    loaded.cloud.labels = std::move(labels);
    loaded.warnings.push_back(
        fmt::format("a result of pcednet: the labels are those of its column {}", column));
    return;
  }
  loaded.warnings.emplace_back(
      "a result of pcednet: its labels are no truth unless they were corrected");
}

}  // namespace

io::LoadedCloud read_labelled(const std::filesystem::path& path) {
  io::LoadedCloud loaded = formats::read_cloud(path);
  PointCloud& cloud = loaded.cloud;
  if (cloud.has_labels() && is_result(cloud)) take_truth_of_result(loaded);
  if (cloud.empty() || cloud.has_labels()) return loaded;
  if (io::extension_of(path) == ".obj") {
    const std::filesystem::path features = find_abc_features(path);
    if (!features.empty()) {
      cloud.labels = read_abc_labels(features, cloud.size());
      loaded.warnings.push_back(fmt::format("labels from {}", features.string()));
      return loaded;
    }
  }
  cloud.labels = labels_of_colours(cloud);
  if (cloud.labels.empty()) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: has no labels", path.string()));
  }
  loaded.warnings.emplace_back("labels from the colours: grey, yellow and red are the classes");
  return loaded;
}

}  // namespace pcednet::truth
