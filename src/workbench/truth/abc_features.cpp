#include "workbench/truth/abc_features.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <charconv>
#include <istream>
#include <streambuf>
#include <string>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/error.h"
#include "pcednet/io/input_file.h"

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

}  // namespace pcednet::truth
