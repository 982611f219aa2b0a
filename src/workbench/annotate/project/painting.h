#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "workbench/annotate/project/journal.h"

namespace pcednet::annotate {

/// `<project>.journal`.
std::filesystem::path journal_of(std::filesystem::path project);

/// The inputs of a project's journal or, without one, of the project; none if neither exists.
/// Throws Error(kUnreadable).
Inputs inputs_of_project(const std::filesystem::path& project);

/// The history of a cloud and its result: labels and settings always equal those from replaying the
/// records, and every record is in the journal, which is written again if its file was deleted.
class Painting {
 public:
  /// Merges the project at `project` (which need not exist) and its journal; `inputs` may continue
  /// theirs, and where some were moved, both have the new places then. Throws Error(kInsufficient)
  /// if one of them is of other inputs or contradicts the other, and as read_project() and Journal
  /// do.
  Painting(const std::filesystem::path& project, const Inputs& inputs);

  const Labels& labels() const { return now_.labels; }
  const Settings& settings() const { return now_.settings; }
  const ProjectClasses& classes() const { return now_.classes; }
  const std::vector<Record>& records() const { return records_; }
  const Replayed& now() const { return now_; }

  /// Appends the record to the journal, then applies it; returns the points that it concerns, valid
  /// until the next call. Throws as the journal does, in which case nothing changes.
  std::span<const std::uint32_t> add(Record record);

  /// The number of the next run.
  int next_run() const;

  /// The number of the run that was shown last, or 0.
  int shown_run() const;

  /// Whether nothing has changed since the shown run.
  bool is_trained() const;

  /// Whether a stroke, undo or redo follows the first `records` records.
  bool is_painted_after(std::size_t records) const;

  /// The number of strokes that are in effect now and were not after the first `records` records,
  /// or the other way round.
  std::size_t strokes_since(std::size_t records) const;

 private:
  Inputs inputs_;
  std::unique_ptr<Journal> journal_;
  std::vector<Record> records_;
  Replayed now_;
};

}  // namespace pcednet::annotate
