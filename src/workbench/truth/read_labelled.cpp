#include "workbench/truth/read_labelled.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/labels.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"
#include "workbench/truth/abc_features.h"
#include "workbench/truth/colour_labels.h"

namespace pcednet::truth {

namespace {

/// The labels of a result are no truth: those that were painted, or those of its input, are.
void take_truth_of_result(io::LoadedCloud& loaded) {
  auto truth = detect::truth_of_result(loaded.cloud);
  if (!truth || (truth->labels.empty() && !loaded.cloud.has_labels())) return;
  if (!truth->labels.empty()) loaded.cloud.labels = std::move(truth->labels);
  loaded.warnings.push_back(std::move(truth->note));
}

/// The first value that is no label up to `most`, nor 255; none if all are.
std::optional<double> find_no_label(const Attribute& attribute, std::size_t points,
                                    std::uint8_t most) {
  for (std::size_t i = 0; i < points; ++i) {
    const auto label = io::to_label(attribute.value(i));
    if (!label || (*label > most && *label != kUnlabelled)) return attribute.value(i);
  }
  return std::nullopt;
}

/// Names of columns in which others keep labels. Classification is of the codes of LAS, and a
/// result of pcednet is no truth.
bool sounds_like_labels(const std::string& name) {
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  return (has("label") || has("class") || has("edge")) && !has("classification") &&
         !has("edge_class") && !has("edgeofflight");
}

/// The field of LAS.
const Attribute* find_classification(const PointCloud& cloud) {
  return io::find_called(cloud, "classification");
}

bool is_varied(const Attribute& attribute, std::size_t points) {
  for (std::size_t i = 1; i < points; ++i) {
    if (attribute.value(i) != attribute.value(0)) return true;
  }
  return false;
}

/// Labels may be among the codes of LAS.
std::string where_coded(const PointCloud& cloud) {
  const Attribute* field = find_classification(cloud);
  if (!field || !is_varied(*field, cloud.size())) return "";
  return fmt::format(
      "; --las-classification of lines, train and evaluate takes them from its field {}",
      field->name);
}

std::string why_unlabelled(const PointCloud& cloud) {
  std::string maybe;
  for (const Attribute& attribute : cloud.attributes) {
    const std::string name = io::lower_case(attribute.name);
    if (attribute.components != 1 || !sounds_like_labels(name)) continue;
    const bool is_named = std::ranges::count(io::label_names(), name) > 0;
    const auto other = find_no_label(attribute, cloud.size(), is_named ? kBoundary : kUnlabelled);
    if (other && is_named) {
      return fmt::format("its column {} holds {}, which is none", attribute.name, *other);
    }
    if (!other && maybe.empty()) maybe = fmt::format("; {} may have to be renamed", attribute.name);
  }
  return "no column is named label" + maybe + where_coded(cloud);
}

/// The values of a field, smallest first; of many the first.
std::string some_values(const Attribute& attribute, std::size_t points) {
  constexpr std::size_t kMost = 12;
  std::set<double> values;
  for (std::size_t i = 0; i < points; ++i) values.insert(attribute.value(i));
  const bool more = values.size() > kMost;
  if (more) values.erase(std::next(values.begin(), kMost), values.end());
  return fmt::format("{}{}", fmt::join(values, ", "), more ? ", ..." : "");
}

}  // namespace

io::LoadedCloud read_labelled(const std::filesystem::path& path) {
  io::LoadedCloud loaded = formats::read_cloud(path);
  PointCloud& cloud = loaded.cloud;
  take_truth_of_result(loaded);
  if (cloud.empty() || cloud.has_labels()) return loaded;
  if (auto column = formats::edge_column_of(cloud)) {
    cloud.labels = std::move(column->classes);
    loaded.warnings.push_back(fmt::format("labels from its column {}", column->column));
    return loaded;
  }
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
    std::string why = why_unlabelled(cloud);
    for (const std::string& warning : loaded.warnings) why += "; " + warning;
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no labels, as {}", path.string(), why));
  }
  loaded.warnings.emplace_back("labels from the colours: grey, yellow and red are the classes");
  take_truth_of_result(loaded);
  return loaded;
}

std::vector<std::uint8_t> coded_labels_of_part(const PointCloud& cloud, const LabelCodes& codes,
                                               const std::filesystem::path& path) {
  const Attribute* field = find_classification(cloud);
  if (!field) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no field Classification", path.string()));
  }
  std::vector<std::uint8_t> labels(cloud.size(), kUnlabelled);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto found = std::ranges::find(codes, field->value(i), &LabelCodes::value_type::second);
    if (found != codes.end()) labels[i] = found->first;
  }
  return labels;
}

std::vector<std::uint8_t> coded_labels(const PointCloud& cloud, const LabelCodes& codes,
                                       const std::filesystem::path& path) {
  auto labels = coded_labels_of_part(cloud, codes, path);
  if (formats::have_labels(labels)) return labels;
  const Attribute& field = *find_classification(cloud);
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: no point has one of the codes given; its field {} holds {}",
                          path.string(), field.name, some_values(field, cloud.size())));
}

io::LoadedCloud read_labelled(const std::filesystem::path& path, const LabelCodes& codes) {
  if (codes.empty()) return read_labelled(path);
  io::LoadedCloud loaded = formats::read_cloud(path);
  PointCloud& cloud = loaded.cloud;
  if (cloud.empty()) return loaded;
  cloud.labels = coded_labels(cloud, codes, path);
  loaded.warnings.push_back(
      fmt::format("labels from its field {}", find_classification(cloud)->name));
  return loaded;
}

}  // namespace pcednet::truth
