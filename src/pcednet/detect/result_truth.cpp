#include "pcednet/detect/result_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/detect/result_cloud.h"

namespace pcednet::detect {
namespace {

/// The labels in a column of a result, of any type, as text has none; none if no point has one, or
/// if a number is no label.
std::vector<std::uint8_t> labels_in(const PointCloud& cloud, const char* column) {
  const Attribute* attribute = find_attribute(cloud, column);
  if (!attribute || attribute->components != 1) return {};
  constexpr double kMost = kUnlabelled;
  std::vector<std::uint8_t> labels(attribute->bytes.size() / attribute->stride());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double value = attribute->value(i);
    if (!(value >= 0.0 && value <= kMost) || value != std::floor(value)) return {};
    labels[i] = static_cast<std::uint8_t>(value);
  }
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
