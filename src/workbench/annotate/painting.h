#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "workbench/annotate/journal.h"

namespace pcednet::annotate {

/// `<project>.journal`.
std::filesystem::path journal_of(std::filesystem::path project);

/// The inputs that the journal of a project, or else the project, is about; none if neither is
/// there. Throws Error(kUnreadable).
Inputs inputs_of_project(const std::filesystem::path& project);

/// What happened to a cloud so far, and where it led: labels and settings are always what replaying
/// the records gives, and every record is in the journal.
class Painting {
 public:
  /// Puts together what the project at `project` (which need not be there) and its journal
  /// remember; `inputs` may go on after theirs. Throws Error(kInsufficient) if one of them is of
  /// other inputs or says
  /// something else than the other, and as read_project() and Journal.
  Painting(const std::filesystem::path& project, const Inputs& inputs);

  const Labels& labels() const { return now_.labels; }
  const Settings& settings() const { return now_.settings; }
  const ProjectClasses& classes() const { return now_.classes; }
  const std::vector<Record>& records() const { return records_; }
  const Replayed& now() const { return now_; }

  /// Does what the record says, after it is in the journal; returns the points that it concerns,
  /// until the next one. Throws as Journal::append(); nothing has happened then.
  std::span<const std::uint32_t> add(Record record);

  /// The number of the run to come.
  int next_run() const;

  /// The number of the run that was shown last, or 0.
  int shown_run() const;

  /// Whether nothing has changed since that run was shown.
  bool is_trained() const;

 private:
  std::unique_ptr<Journal> journal_;
  std::vector<Record> records_;
  Replayed now_;
};

}  // namespace pcednet::annotate
