#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "workbench/annotate/project/project.h"

namespace pcednet::annotate {
namespace {

using Kind = Record::Kind;

[[noreturn]] void refuse_records(const std::string& why) {
  throw Error(ErrorKind::kUnreadable, why);
}

}  // namespace

void follow_classes(const Record& record, ProjectClasses& classes) {
  if (record.kind == Kind::kClasses) classes = record.classes;
  if (record.kind != Kind::kStroke || record.edge_class == kUnlabelled) return;
  if (classes.may_paint(record.edge_class)) return;
  refuse_records(fmt::format("a stroke of class {}, which the project lacks", record.edge_class));
}

std::span<const std::uint32_t> replay(const Record& record, Replayed& now) {
  follow_classes(record, now.classes);
  switch (record.kind) {
    case Kind::kStroke:
      if (record.edge_class != kUnlabelled) now.ever_painted.insert(record.edge_class);
      return now.labels.paint(record.edge_class, record.points);
    case Kind::kUndo:
      return now.labels.undo();
    case Kind::kRedo:
      return now.labels.redo();
    case Kind::kSettings:
      now.settings = record.settings;
      return {};
    case Kind::kClasses:
      return {};
    case Kind::kRun:
      now.run = now.runs[record.run.number] = record.run;
      return {};
    case Kind::kRestore:
      break;
  }
  if (const auto found = now.runs.find(record.run.number); found != now.runs.end()) {
    now.run = found->second;
  }
  return {};
}

Replayed replay(std::span<const Record> records, std::size_t points) {
  Replayed now{.labels = Labels(points)};
  for (const Record& record : records) replay(record, now);
  return now;
}

Labels labels_of(const RunRecord& run, std::span<const Record> records, std::size_t points) {
  const auto own = std::find_if(records.begin(), records.end(), [&](const Record& record) {
    return record.kind == Kind::kRun && record.run.number == run.number;
  });
  const auto before = static_cast<std::size_t>(own - records.begin());
  if (run.records > before) {
    refuse_records(fmt::format("run {} was trained on {} records, but only {} are before it",
                               run.number, run.records, before));
  }
  Labels labels = replay(records.first(run.records), points).labels;
  const std::size_t painted = labels.painted();
  if (run.facts.painted && *run.facts.painted != painted) {
    refuse_records(fmt::format("run {} was trained on {} painted points, but its records paint {}",
                               run.number, *run.facts.painted, painted));
  }
  return labels;
}

}  // namespace pcednet::annotate
