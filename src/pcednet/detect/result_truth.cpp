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

/// Other programs drop the comments and keep the columns.
bool is_result(const PointCloud& cloud) {
  return has_result_columns(cloud) || names_model(cloud);
}

/// Whether somebody corrected the classes rather than the labels, which were the same: those
/// corrected agree less with the probabilities where they differ.
bool corrects_classes(const PointCloud& cloud, const std::vector<std::uint8_t>& classes) {
  const Attribute& p_sharp = *find_attribute(cloud, kResultColumns[1]);
  const Attribute& p_smooth = *find_attribute(cloud, kResultColumns[2]);
  std::size_t by_classes = 0, by_labels = 0;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] == cloud.labels[i]) continue;
    const double sharp = p_sharp.value(i), smooth = p_smooth.value(i);
    const EdgeClass predicted = sharp + smooth <= 0.5 ? kNonEdge
                                : sharp >= smooth     ? kSharpEdge
                                                      : kSmoothEdge;
    by_classes += classes[i] == predicted ? 1 : 0;
    by_labels += cloud.labels[i] == predicted ? 1 : 0;
  }
  return by_classes <= by_labels;
}

/// A result has its classes in two columns, of which another program may have corrected one.
ResultTruth own_labels(const PointCloud& cloud) {
  const char* unless = "no truth unless they were corrected";
  auto classes = labels_in(cloud, kResultColumns[0]);
  if (!classes.empty() && !cloud.has_labels()) {
    return {std::move(classes), fmt::format("a result of pcednet: the labels of its column {} are "
                                            "{}",
                                            kResultColumns[0], unless)};
  }
  if (classes.size() != cloud.labels.size() || classes == cloud.labels ||
      !has_result_columns(cloud)) {
    return {.note = fmt::format("a result of pcednet: its labels are {}", unless)};
  }
  const bool by_classes = corrects_classes(cloud, classes);
  if (!by_classes) classes = cloud.labels;
  return {std::move(classes),
          fmt::format("a result of pcednet: the labels are those of its column {}, which was "
                      "corrected",
                      by_classes ? kResultColumns[0] : "label")};
}

}  // namespace

bool has_result_columns(const PointCloud& cloud) {
  return std::all_of(kResultColumns.begin(), kResultColumns.end(), [&](const char* column) {
    const Attribute* attribute = find_attribute(cloud, column);
    return attribute && attribute->components == 1;
  });
}

bool names_model(const PointCloud& cloud) {
  return std::any_of(cloud.comments.begin(), cloud.comments.end(),
                     [](const std::string& one) { return one.starts_with(kModelComment); });
}

std::optional<ResultTruth> truth_of_result(const PointCloud& cloud) {
  if (!is_result(cloud)) return std::nullopt;
  for (const char* column : kTruthColumns) {
    auto labels = labels_in(cloud, column);
    if (labels.empty()) continue;
    auto note = fmt::format("a result of pcednet: the labels are those of its column {}", column);
    return ResultTruth{std::move(labels), std::move(note)};
  }
  return own_labels(cloud);
}

}  // namespace pcednet::detect
