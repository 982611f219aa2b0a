#include "pcednet/formats/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "pcednet/core/error.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/file_lines.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::formats {
namespace {

using Classes = std::optional<std::size_t>;  ///< how many there are, if that is known

bool is_label(std::uint8_t number, Classes classes) {
  return !classes || number < *classes || number == kUnlabelled;
}

std::optional<std::uint8_t> parse_label(std::string_view word, Classes classes) {
  const auto value = io::parse_double(word);
  if (!value || (classes && std::isnan(*value))) return std::nullopt;
  const auto label = io::to_label(*value);
  return label && is_label(*label, classes) ? label : std::nullopt;
}

std::string expected_label(Classes classes) {
  return classes ? fmt::format("expected a class in 0 ... {}, or 255 or -1", *classes - 1)
                 : "expected a label in 0 ... 255 or -1";
}

std::vector<std::uint8_t> read_bytes(const io::InputFile& file, Classes classes) {
  std::vector<std::uint8_t> labels(file.size());
  file.read(0, std::as_writable_bytes(std::span(labels)));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (is_label(labels[i], classes)) continue;
    throw io::unreadable(file.path(),
                         fmt::format("byte {}: {}, not {}", i, expected_label(classes), labels[i]));
  }
  return labels;
}

/// Labels from a text with one number a line; none if a line holds several, also after a line with
/// one that is no label, such as the number of points.
std::optional<std::vector<std::uint8_t>> read_text_labels(const io::InputFile& file,
                                                          Classes classes) {
  std::vector<std::uint8_t> labels;
  std::vector<std::string_view> words;
  io::FileLines lines(file);
  std::string_view line;
  std::optional<Error> no_label;
  while (lines.next(line)) {
    line = io::trim(line);
    if (line.empty() || io::is_comment(line)) continue;
    io::split(line, words, io::kNumberSeparators);
    if (words.size() != 1) return std::nullopt;
    const auto label = parse_label(words[0], classes);
    if (!label && !no_label) {
      no_label = io::unreadable(file.path(),
                                fmt::format("{}, not {:.40}", expected_label(classes), words[0]),
                                lines.number());
    }
    labels.push_back(label.value_or(kUnlabelled));
  }
  if (no_label) throw *no_label;
  return labels;
}

std::vector<std::uint8_t> read_cloud_labels(const std::filesystem::path& path) {
  const PointCloud cloud = read_cloud(path).cloud;
  std::vector<std::uint8_t> labels = labels_of(cloud, path);
  if (labels.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: no labels; expected scalar_edge_class, edge_class or label",
                            path.string()));
  }
  return labels;
}

/// The attribute `name` or scalar_`name`, in any case, if its numbers are all of EdgeClass or
/// unlabelled.
const Attribute* column_of_classes(const PointCloud& cloud, const std::string& name) {
  for (const Attribute& attribute : cloud.attributes) {
    if (!io::is_called(attribute, name)) continue;
    bool fits = true;
    for (std::size_t i = 0; i < cloud.size() && fits; ++i) {
      const auto label = io::to_label(attribute.value(i));
      fits = label && is_label(*label, kBoundary + 1);
    }
    if (fits) return &attribute;
  }
  return nullptr;
}

}  // namespace

std::optional<ColumnLabels> edge_column_of(const PointCloud& cloud) {
  for (const std::string name : {"label", "is_edge", "edge", "edge_label"}) {
    const Attribute* attribute = column_of_classes(cloud, name);
    if (!attribute) continue;
    ColumnLabels found = {.classes = *io::to_labels(*attribute, cloud.size()),
                          .column = attribute->name};
    const bool yes_or_no =
        name != "label" &&
        std::all_of(found.classes.begin(), found.classes.end(),
                    [](std::uint8_t label) { return label <= 1 || label == kUnlabelled; });
    if (yes_or_no) {
      std::replace(found.classes.begin(), found.classes.end(), std::uint8_t{1},
                   static_cast<std::uint8_t>(kSharpEdge));
    }
    return found;
  }
  return std::nullopt;
}

std::string doubtful_column_of(const PointCloud& cloud) {
  for (const char* name : {"class", "classification"}) {
    if (const Attribute* attribute = column_of_classes(cloud, name)) return attribute->name;
  }
  return "";
}

std::vector<std::uint8_t> labels_of(const PointCloud& cloud, const std::filesystem::path& path) {
  for (const char* name : {"scalar_edge_class", "edge_class"}) {
    const Attribute* attribute = find_attribute(cloud, name);
    if (!attribute) continue;
    std::vector<std::uint8_t> labels;
    labels.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto label = io::to_label(attribute->value(i));
      if (!label) {
        throw Error(ErrorKind::kInsufficient,
                    fmt::format("{}: {} of point {} is {}, no class", path.string(), name, i,
                                attribute->value(i)));
      }
      labels.push_back(*label);
    }
    return labels;
  }
  return cloud.labels;
}

std::optional<std::vector<std::uint8_t>> read_bare_labels(const std::filesystem::path& path,
                                                          std::optional<std::size_t> classes) {
  const std::string extension = io::extension_of(path);
  if (extension == ".u8") return read_bytes(io::InputFile(path), classes);
  const bool labels_only = extension == ".lbl" || extension == ".seg";
  if (!labels_only && extension != ".txt" && extension != ".csv") return std::nullopt;
  auto labels = read_text_labels(io::InputFile(path), classes);
  if (!labels && labels_only) throw io::unreadable(path, "expected one label a line");
  return labels;
}

std::vector<std::uint8_t> read_labels(const std::filesystem::path& path) {
  auto labels = read_bare_labels(path);
  return labels ? *std::move(labels) : read_cloud_labels(path);
}

bool have_labels(std::span<const std::uint8_t> labels) {
  return std::any_of(labels.begin(), labels.end(),
                     [](std::uint8_t label) { return label != kUnlabelled; });
}

}  // namespace pcednet::formats
