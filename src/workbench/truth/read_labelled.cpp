#include "workbench/truth/read_labelled.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <istream>
#include <map>
#include <optional>
#include <set>
#include <streambuf>
#include <string>
#include <utility>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/detect/result_truth.h"
#include "pcednet/formats/labels.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::truth {
namespace {

namespace fs = std::filesystem;

/// Extracts `curves: - {sharp: ..., vert_indices: [...]}` from the events of a YAML parser, so that
/// the file, which can be ten times as large as the mesh, is never held as a tree.
class CurveHandler : public YAML::EventHandler {
 public:
  CurveHandler(const fs::path& path, std::size_t points) : path_(path) {
    labels_.assign(points, kNonEdge);
  }

  std::vector<std::uint8_t> labels() && { return std::move(labels_); }
  bool found_curves() const { return found_curves_; }

  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(true);
  }
  void OnMapEnd() override {
    if (is_curve()) end_curve();
    close();
  }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(false);
    if (levels_.size() == 2 && key(0) == "curves") found_curves_ = true;
  }
  void OnSequenceEnd() override { close(); }

  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    if (levels_.empty()) return;
    Level& level = levels_.back();
    if (level.is_map && level.wants_key) {
      level.key = value;
      level.wants_key = false;
      return;
    }
    if (is_curve() && level.key == "sharp") sharp_ = value == "true" || value == "True";
    const bool in_curve = levels_.size() == 4 && !level.is_map && key(0) == "curves";
    if (in_curve && key(2) == "vert_indices") take_vertex(mark, value);
    level.wants_key = level.is_map;
  }
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    OnScalar(mark, "", anchor, "");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    OnScalar(mark, "", anchor, "");
  }
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

 private:
  struct Level {
    bool is_map = false, wants_key = false;
    std::string key = {};
  };

  const std::string& key(std::size_t level) const { return levels_[level].key; }
  bool is_curve() const {
    return levels_.size() == 3 && levels_[2].is_map && !levels_[1].is_map && key(0) == "curves";
  }
  void open(bool is_map) { levels_.push_back({is_map, is_map}); }
  void close() {
    levels_.pop_back();
    if (!levels_.empty()) levels_.back().wants_key = levels_.back().is_map;
  }

  void take_vertex(const YAML::Mark& mark, const std::string& word) {
    std::size_t vertex = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), vertex);
    if (fault != std::errc{} || end != word.data() + word.size() || vertex >= labels_.size()) {
      throw io::unreadable(path_,
                           fmt::format("expected the number of one of {} vertices, not {:.40}",
                                       labels_.size(), word),
                           static_cast<std::size_t>(mark.line) + 1);
    }
    vertices_.push_back(vertex);
  }

  void end_curve() {
    if (sharp_) {
      for (const std::size_t vertex : vertices_) labels_[vertex] = kSharpEdge;
    }
    vertices_.clear();
    sharp_ = false;
  }

  const fs::path& path_;
  std::vector<Level> levels_;
  bool found_curves_ = false, sharp_ = false;  ///< the latter: the curve being read
  std::vector<std::size_t> vertices_;          ///< of that curve
  std::vector<std::uint8_t> labels_;
};

bool replace(std::string& text, std::string_view what, std::string_view with) {
  const std::size_t place = text.rfind(what);
  if (place == std::string::npos) return false;
  text.replace(place, what.size(), with);
  return true;
}

/// A stream over text in memory.
struct TextBuffer : std::streambuf {
  explicit TextBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
};

/// The labels of a result are no truth: those that were painted, or those of its input, are.
void take_truth_of_result(io::LoadedCloud& loaded) {
  auto truth = detect::truth_of_result(loaded.cloud);
  if (!truth || (truth->labels.empty() && !loaded.cloud.has_labels())) return;
  if (!truth->labels.empty()) loaded.cloud.labels = std::move(truth->labels);
  loaded.warnings.push_back(std::move(truth->note));
}

/// The first value that is no label; none if all are.
std::optional<double> find_no_label(const Attribute& attribute, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) {
    if (!io::to_label(attribute.value(i))) return attribute.value(i);
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

/// The field of LAS, also as CloudCompare calls it.
const Attribute* find_classification(const PointCloud& cloud) {
  const auto found = std::ranges::find_if(cloud.attributes, [](const Attribute& attribute) {
    const std::string name = io::lower_case(attribute.name);
    return attribute.components == 1 &&
           (name == "classification" || name == "scalar_classification");
  });
  return found == cloud.attributes.end() ? nullptr : &*found;
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
    const auto other = find_no_label(attribute, cloud.size());
    if (other && std::ranges::count(io::label_names(), name) > 0) {
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

using Colour = std::array<std::uint8_t, 3>;

std::optional<std::uint8_t> class_of(const Colour& colour) {
  const int red = colour[0], green = colour[1], blue = colour[2];
  if (std::max({red, green, blue}) - std::min({red, green, blue}) <= 16) return kNonEdge;
  if (blue >= 96 && red < blue / 4) return kBoundary;
  if (red < 96 || blue > green + 16) return std::nullopt;
  if (green < red / 4) return kSharpEdge;
  if (green > red / 2 && blue < red * 2 / 3) return kSmoothEdge;
  return std::nullopt;
}

}  // namespace

fs::path find_abc_features(const fs::path& mesh) {
  std::string name = mesh.stem().string();
  replace(name, "_trimesh_", "_features_");
  std::vector<fs::path> candidates = {mesh.parent_path() / (name + ".yml")};
  for (const char* folder : {"obj", "stl2"}) {
    std::string parent = fmt::format("/{}/", mesh.parent_path().string());
    if (!replace(parent, fmt::format("/{}/", folder), "/feat/")) continue;
    candidates.push_back(fs::path(parent.substr(1)) / (name + ".yml"));
  }
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    if (fs::is_regular_file(candidate, error)) return candidate;
  }
  return {};
}

std::vector<std::uint8_t> read_abc_labels(const fs::path& features, std::size_t points) {
  std::string text = io::InputFile(features).text();
  TextBuffer buffer(text);
  std::istream stream(&buffer);
  CurveHandler handler(features, points);
  try {
    YAML::Parser(stream).HandleNextDocument(handler);
  } catch (const YAML::Exception& error) {
    throw io::unreadable(features, error.msg, static_cast<std::size_t>(error.mark.line) + 1);
  }
  if (!handler.found_curves()) throw io::unreadable(features, "has no curves of an ABC model");
  return std::move(handler).labels();
}

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
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no labels, as {}", path.string(), why_unlabelled(cloud)));
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

std::vector<std::uint8_t> labels_of_colours(const PointCloud& cloud) {
  std::map<Colour, std::uint8_t> classes;
  for (const auto& colour : cloud.colours) {
    const Colour key = {colour[0], colour[1], colour[2]};
    if (classes.contains(key)) continue;
    const auto found = class_of(key);
    const bool taken = std::any_of(classes.begin(), classes.end(),
                                   [&](const auto& entry) { return entry.second == found; });
    if (!found || taken) return {};
    classes[key] = *found;
  }
  const bool has_red = std::any_of(classes.begin(), classes.end(),
                                   [](const auto& entry) { return entry.second == kSharpEdge; });
  if (classes.size() < 2 || !has_red) return {};
  std::vector<std::uint8_t> labels;
  labels.reserve(cloud.size());
  for (const auto& colour : cloud.colours) {
    labels.push_back(classes.at({colour[0], colour[1], colour[2]}));
  }
  return labels;
}

}  // namespace pcednet::truth
