#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "workbench/annotate/project/project.h"

namespace pcednet::annotate {

/// A file that gains a line per record and survives the end of the program at any moment: its first
/// line names the inputs; an incomplete last line is dropped, and blank lines mean nothing.
class Journal {
 public:
  /// Opens the journal at `path`, or begins one with `records`. `records` becomes the content of
  /// the journal, which then names all `inputs`: before, it may lack the last ones or have other
  /// names of them. Throws Error(kUnreadable) if it cannot be read or, naming the line and what to
  /// do, if it is damaged before its end, Error(kInsufficient) as check_known(), Error(kFailure) if
  /// it cannot be written.
  Journal(std::filesystem::path path, const Inputs& inputs, std::vector<Record>& records);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Adds a record and flushes it to disk. Throws Error(kFailure), in which case the record is not
  /// added.
  void append(const Record& record);

  /// Writes the journal again, from all its records, if its file was deleted: lines added to that
  /// would be lost. Throws Error(kFailure) if that fails or another file is in its place.
  void restore_if_deleted(const Inputs& inputs, std::span<const Record> records);

 private:
  void open();
  void read(const Inputs& inputs, std::vector<Record>& records);
  void rewrite(const std::string& text);
  void write_line(const std::string& line);
  [[noreturn]] void take_back();
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  int file_ = -1;
  std::size_t size_ = 0;  ///< bytes of whole lines
};

/// The inputs that the journal at `path` names; none if there is no journal or its first line is
/// incomplete. Throws Error(kUnreadable), naming the file and what to do.
Inputs inputs_of_journal(const std::filesystem::path& path);

/// Throws Error(kFailure) if another annotator has the journal at `path` open, as Journal() does.
void check_not_open(const std::filesystem::path& path);

}  // namespace pcednet::annotate
