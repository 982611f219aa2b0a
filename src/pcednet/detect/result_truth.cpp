#include "pcednet/detect/result_truth.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/detect/result_cloud.h"

namespace pcednet::detect {
namespace {

/// The labels in a column of a result; none if no point has one.
std::vector<std::uint8_t> labels_in(const PointCloud& cloud, const char* column) {
  const Attribute* attribute = find_attribute(cloud, column);
  if (!attribute || attribute->type != ScalarType::kUint8 || attribute->components != 1) return {};
  std::vector<std::uint8_t> labels(attribute->bytes.size());
  std::transform(attribute->bytes.begin(), attribute->bytes.end(), labels.begin(),
                 [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
  const auto is_label = [](std::uint8_t label) { return label != kUnlabelled; };
  if (std::none_of(labels.begin(), labels.end(), is_label)) labels.clear();
  return labels;
}

}  // namespace

std::optional<ResultTruth> truth_of_result(const PointCloud& cloud) {
  if (std::none_of(cloud.comments.begin(), cloud.comments.end(),
                   [](const std::string& one) { return one.starts_with(kModelComment); })) {
    return std::nullopt;
  }
  for (const char* column : kTruthColumns) {
    auto labels = labels_in(cloud, column);
    if (labels.empty()) continue;
    auto note = fmt::format("a result of pcednet: the labels are those of its column {}", column);
    return ResultTruth{std::move(labels), std::move(note)};
  }
  return ResultTruth{.note =
                         "a result of pcednet: its labels are no truth unless they were "
                         "corrected"};
}

}  // namespace pcednet::detect
