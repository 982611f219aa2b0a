#include "workbench/annotate/project/painting.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/error.h"
#include "workbench/annotate/project/known_files.h"

namespace pcednet::annotate {
namespace {

namespace fs = std::filesystem;

Project read_own_project(const fs::path& path) {
  try {
    return read_project(path);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kUnreadable) throw;
    throw Error(error.kind(), fmt::format("{}; move it away to start afresh", error.what()));
  }
}

Project saved_project(const fs::path& path, const Inputs& inputs) {
  if (!fs::exists(path)) return {};
  Project project = read_own_project(path);
  check_known(path, project.inputs, inputs);
  return project;
}

/// Saves where the inputs are now, if some were moved.
void follow_inputs(const fs::path& path, Project& project, const Inputs& inputs) {
  const Inputs now(inputs.begin(),
                   inputs.begin() + static_cast<std::ptrdiff_t>(project.inputs.size()));
  if (now == project.inputs) return;
  project.inputs = now;
  write_project(path, project, Overwrite::kYes);
}

}  // namespace

fs::path journal_of(fs::path project) {
  return project += ".journal";
}

Inputs inputs_of_project(const fs::path& project) {
  if (Inputs known = inputs_of_journal(journal_of(project)); !known.empty()) return known;
  return fs::exists(project) ? read_own_project(project).inputs : Inputs();
}

Painting::Painting(const fs::path& project, const Inputs& inputs)
    : inputs_(inputs), now_{.labels = Labels(points_of(inputs))} {
  Project on_disk = saved_project(project, inputs);
  const std::vector<Record>& saved = on_disk.records;
  records_ = saved;
  const fs::path path = journal_of(project);
  journal_ = std::make_unique<Journal>(path, inputs, records_);
  for (std::size_t i = 0; i < std::min(saved.size(), records_.size()); ++i) {
    if (to_line(saved[i]) != to_line(records_[i])) {
      throw Error(ErrorKind::kInsufficient, fmt::format("{} and {} disagree: move one of them away",
                                                        project.string(), path.string()));
    }
  }
  for (std::size_t i = records_.size(); i < saved.size(); ++i) {
    journal_->append(saved[i]);
    records_.push_back(saved[i]);
  }
  for (const Record& record : records_) replay(record, now_);
  follow_inputs(project, on_disk, inputs);
}

std::span<const std::uint32_t> Painting::add(Record record) {
  journal_->restore_if_deleted(inputs_, records_);
  journal_->append(record);
  records_.push_back(std::move(record));
  return replay(records_.back(), now_);
}

int Painting::next_run() const {
  return now_.runs.empty() ? 1 : now_.runs.rbegin()->first + 1;
}

int Painting::shown_run() const {
  return now_.run ? now_.run->number : 0;
}

bool Painting::is_trained() const {
  const auto last = std::find_if(records_.rbegin(), records_.rend(), [](const Record& record) {
    return record.kind != Record::Kind::kClasses;  // names and colours are not learnt
  });
  return last != records_.rend() &&
         (last->kind == Record::Kind::kRun || last->kind == Record::Kind::kRestore);
}

bool Painting::is_painted_after(std::size_t records) const {
  const auto first = std::min(records, records_.size());
  return std::any_of(records_.begin() + static_cast<std::ptrdiff_t>(first), records_.end(),
                     [](const Record& record) {
                       return record.kind == Record::Kind::kStroke ||
                              record.kind == Record::Kind::kUndo ||
                              record.kind == Record::Kind::kRedo;
                     });
}

std::size_t Painting::strokes_since(std::size_t records) const {
  if (!is_painted_after(records)) return 0;
  const auto before = std::span(records_).first(std::min(records, records_.size()));
  return now_.labels.steps_since(replay(before, points_of(inputs_)).labels);
}

}  // namespace pcednet::annotate
