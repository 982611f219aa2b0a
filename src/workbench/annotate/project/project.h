#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/core/output_file.h"
#include "workbench/annotate/project/classes.h"
#include "workbench/annotate/project/labels.h"

namespace pcednet::annotate {

/// The start of a training that begins with random weights.
inline constexpr const char* kRandomStart = "random";

struct Settings {
  int classes = 3;                   ///< 2: sharp-edge and the rest
  bool automatic = true;             ///< train shortly after every stroke
  std::string start = kRandomStart;  ///< or the model whose weights training starts from
  std::uint64_t seed = 1;
  bool operator==(const Settings&) const = default;
};

/// The settings that a request changes; the others stay.
struct SettingsChange {
  std::optional<int> classes = {};
  std::optional<bool> automatic = {};
  std::optional<std::string> start = {};
  std::optional<std::uint64_t> seed = {};
};

/// `settings` with the change. Throws Error(kUsage) unless there are 2 or 3 classes.
Settings changed(Settings settings, const SettingsChange& change);

/// Facts on a run that are known without training it again; records of the first version have none.
struct RunFacts {
  std::optional<std::size_t> painted = {};  ///< points
  std::optional<int> classes = {};
  std::optional<double> loss = {}, seconds_train = {}, seconds_classify = {};
  std::string time = {};  ///< ISO 8601, UTC
};

/// The basis of a training: the labels after `records` records, under these settings.
struct RunRecord {
  int number = 0;
  std::size_t records = 0;
  Settings settings = {};
  RunFacts facts = {};
  std::size_t clouds = 1;  ///< the number of inputs then; others joined later
};

/// One event. A stroke is kept as the points that it changed, so that replaying it needs neither
/// the view nor the prediction at the time.
struct Record {
  enum class Kind { kStroke, kUndo, kRedo, kSettings, kClasses, kRun, kRestore };
  Kind kind = Kind::kStroke;
  std::string id = {};  ///< of a stroke
  std::uint8_t edge_class = kUnlabelled;
  std::vector<std::uint32_t> points = {};  ///< ascending
  Settings settings = {};
  ProjectClasses classes = {};
  RunRecord run = {};  ///< of kRestore the number alone
};

/// Reads `{"classes": [...]}` of the page. Throws Error(kUsage), naming the fault.
ProjectClasses parse_classes_change(std::string_view json);

/// The input that records refer to.
struct InputIdentity {
  /// Without its folder; of a further input as seen from the first's. UTF-8, see as_utf8().
  std::string name = {};
  std::string digest = {};  ///< of the file's bytes
  std::size_t points = 0;
  bool operator==(const InputIdentity&) const = default;
};

/// The inputs of a project; its points are numbered through all inputs in order.
using Inputs = std::vector<InputIdentity>;
std::size_t points_of(std::span<const InputIdentity> inputs);

/// The digest of a file's bytes. Throws Error(kUnreadable).
std::string digest_of_file(const std::filesystem::path& path);

struct Project {
  Inputs inputs = {};
  std::vector<Record> records = {};
};

/// One line of JSON, without its end; that of the inputs is the first line of a journal.
std::string to_line(const Record& record);
std::string to_line(const Inputs& inputs);

/// Read the output of to_line(). Throw Error(kUnreadable), naming the fault.
Record parse_record(std::string_view line, std::size_t points);
Inputs parse_inputs(std::string_view line);

/// The settings as a record has them.
std::string to_line(const Settings& settings);

/// Throws Error(kUsage) for a setting of the wrong kind.
SettingsChange parse_settings_change(std::string_view json);

/// Throws Error(kUnreadable), naming the file, for anything but a project.
Project read_project(const std::filesystem::path& path);
void write_project(const std::filesystem::path& path, const Project& project, Overwrite overwrite);

/// Takes over the classes of a record that has some; throws Error(kUnreadable) for a stroke of a
/// class that `classes` do not paint.
void follow_classes(const Record& record, ProjectClasses& classes);

/// The state after replaying records.
struct Replayed {
  Labels labels;
  Settings settings = {};
  ProjectClasses classes = {};
  std::set<std::uint8_t> ever_painted = {};  ///< classes of strokes, those taken back too
  std::map<int, RunRecord> runs = {};        ///< all, by their numbers
  std::optional<RunRecord> run = {};         ///< the last one shown
};
Replayed replay(std::span<const Record> records, std::size_t points);

/// Applies one more record; returns the points that it concerns, valid until the next call.
std::span<const std::uint32_t> replay(const Record& record, Replayed& now);

/// The labels that a run of `records` was trained on. Throws Error(kUnreadable) if there are too
/// few records before it, or they paint another number of points than the run had.
Labels labels_of(const RunRecord& run, std::span<const Record> records, std::size_t points);

}  // namespace pcednet::annotate
