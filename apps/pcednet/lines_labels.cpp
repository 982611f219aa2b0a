#include "lines_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "common.h"
#include "pcednet/core/error.h"
#include "pcednet/formats/format.h"
#include "pcednet/formats/labels.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"
#include "workbench/truth/read_labelled.h"

namespace pcednet::app {
namespace {

/// The attribute scalar_`name` or `name` of every point; empty if there is none.
std::vector<float> probabilities(const std::string& file, const PointCloud& cloud,
                                 const std::string& name) {
  for (const std::string& spelling : {"scalar_" + name, name}) {
    const Attribute* attribute = find_attribute(cloud, spelling);
    if (!attribute || attribute->components != 1) continue;
    std::vector<float> values(cloud.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(attribute->value(i));
      if (values[i] >= 0.0f && values[i] <= 1.0f) continue;
      throw Error(ErrorKind::kInsufficient,
                  fmt::format("{}: {} of point {} is {}, which is not in [0, 1]", file, spelling, i,
                              values[i]));
    }
    return values;
  }
  return {};
}

/// A column that is named as labels and holds another number, such as a probability.
void tell_of_no_labels(const std::string& file, const PointCloud& cloud) {
  for (const Attribute& attribute : cloud.attributes) {
    const auto& names = io::label_names();
    const bool is_named = std::ranges::count(names, io::lower_case(attribute.name)) > 0;
    if (!is_named || attribute.components != 1) continue;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (io::to_label(attribute.value(i))) continue;
      return say(fmt::format("{}: its column {} is not taken for classes: it holds {}", file,
                             attribute.name, attribute.value(i)));
    }
  }
}

}  // namespace

std::vector<std::uint8_t> labels_to_draw(const LinesArguments& arguments, const PointCloud& cloud) {
  const std::string& file = arguments.input;
  if (!arguments.codes.empty() && !cloud.empty()) {
    auto coded = truth::coded_labels(cloud, arguments.codes, file);
    say(fmt::format("{}: labels from its field Classification", file));
    return coded;
  }
  std::vector<std::uint8_t> labels = formats::labels_of(cloud, file);
  if (cloud.has_labels() && labels != cloud.labels) {
    warn(fmt::format("{}: its columns edge_class and label differ: edge_class is drawn", file));
  }
  if (!labels.empty()) return labels;
  if (auto column = formats::edge_column_of(cloud)) {
    say(fmt::format("{}: labels from its column {}", file, column->column));
    return std::move(column->classes);
  }
  const std::string doubtful = formats::doubtful_column_of(cloud);
  const formats::Format* format = formats::find_format(file);
  if (!doubtful.empty() && !(format && format->is_las())) {
    say(fmt::format(
        "{}: its column {} is not taken for edge classes: in other programs 2 is ground; "
        "call it label if they are",
        file, doubtful));
  }
  tell_of_no_labels(file, cloud);
  return {};
}

detect::Classification with_probabilities(const LinesArguments& arguments, const PointCloud& cloud,
                                          std::vector<std::uint8_t> classes) {
  detect::Classification found;
  found.classes = std::move(classes);
  found.p_sharp = probabilities(arguments.input, cloud, "p_sharp");
  if (found.p_sharp.empty()) return found;
  found.p_smooth = probabilities(arguments.input, cloud, "p_smooth");
  found.p_smooth.resize(cloud.size());
  return found;
}

detect::Classification labels_of_part(const LinesArguments& arguments, const PointCloud& part) {
  detect::Classification found =
      with_probabilities(arguments, part,
                         arguments.codes.empty()
                             ? formats::labels_of(part, arguments.input)
                             : truth::coded_labels_of_part(part, arguments.codes, arguments.input));
  if (!found.p_sharp.empty()) return found;
  for (const std::uint8_t its_class : found.classes) {  // find_lines() then uses classes only
    const bool edge = its_class == kSharpEdge || its_class == kSmoothEdge;
    found.p_sharp.push_back(edge ? 1.0f : 0.0f);
  }
  found.p_smooth.resize(part.size());
  return found;
}

}  // namespace pcednet::app
