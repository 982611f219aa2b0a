#include "workbench/annotate/project/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/io/input_file.h"
#include "workbench/annotate/project/known_files.h"

namespace pcednet::annotate {
namespace {

/// Takes a lock that lasts until the file is closed: two annotators of one project would write
/// between each other's lines.
void lock(int file, int operation, const std::filesystem::path& path) {
  if (::flock(file, operation | LOCK_NB) == 0) return;
  throw Error(ErrorKind::kFailure, fmt::format("{}: another annotator has it open", path.string()));
}

/// Whether a line holds nothing; a crash of the machine may leave NUL bytes.
bool is_blank(std::string_view line) {
  return line.find_first_not_of(std::string_view(" \t\r\0", 4)) == line.npos;
}

/// What is wrong with a line: the reader of JSON, which sees that line alone, numbers it 1.
std::string without_line(std::string words) {
  const std::string number = "at line 1, ";
  const std::size_t at = words.find(number);
  return at == words.npos ? words : words.replace(at, number.size(), "at ");
}

/// Runs `parse` for a line of the journal; its errors name the line and what to do.
template <typename Parse>
void parse_line(const std::filesystem::path& path, std::size_t line, Parse&& parse) {
  try {
    parse();
  } catch (const Error& error) {
    const std::string mend =
        line == 1 ? "move the journal away to start afresh, or from the saved project"
                  : fmt::format(
                        "to keep the strokes before it, copy the journal to a safe place, "
                        "then delete from line {} to the end",
                        line);
    throw Error(ErrorKind::kUnreadable, fmt::format("{}: line {}: {}; {}", path.string(), line,
                                                    without_line(error.what()), mend));
  }
}

}  // namespace

Inputs inputs_of_journal(const std::filesystem::path& path) {
  std::ifstream journal(path);
  std::string line;
  if (!std::getline(journal, line) || journal.eof()) return {};
  Inputs inputs;
  parse_line(path, 1, [&] { inputs = parse_inputs(line); });
  return inputs;
}

void check_not_open(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  try {
    lock(file, LOCK_SH, path);
  } catch (...) {
    ::close(file);
    throw;
  }
  ::close(file);
}

Journal::Journal(std::filesystem::path path, const Inputs& inputs, std::vector<Record>& records)
    : path_(std::move(path)) {
  try {
    open();
    read(inputs, records);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

void Journal::open() {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) fail("cannot be opened");
  lock(file_, LOCK_EX, path_);
}

/// Replaces the file atomically: either the old or the new one exists at any moment.
void Journal::rewrite(const std::string& text) {
  write_text_file(path_, text, Overwrite::kYes);
  ::close(file_);
  open();
  size_ = text.size();
}

Journal::~Journal() {
  if (file_ >= 0) ::close(file_);
}

void Journal::fail(const char* what) const {
  throw Error(ErrorKind::kFailure,
              fmt::format("{}: {}: {}", path_.string(), what, std::strerror(errno)));
}

void Journal::read(const Inputs& inputs, std::vector<Record>& records) {
  const std::string text = io::InputFile(path_).text();
  std::vector<Record> found;
  Inputs known;
  ProjectClasses classes;
  std::size_t lines = 0, head = 0, points = 0;
  for (std::size_t end; (end = text.find('\n', size_)) != std::string::npos; size_ = end + 1) {
    const std::string_view line = std::string_view(text).substr(size_, end - size_);
    if (++lines == 1) {
      parse_line(path_, lines, [&] { known = parse_inputs(line); });
      check_known(path_, known, inputs);
      points = points_of(std::span(inputs).first(known.size()));
      head = end + 1;
    } else if (!is_blank(line)) {
      parse_line(path_, lines, [&] {
        found.push_back(parse_record(line, points));
        follow_classes(found.back(), classes);
      });
    }
  }
  if (::ftruncate(file_, static_cast<off_t>(size_)) != 0) fail("cannot be mended");
  if (lines > 0 && known != inputs) {  // others joined, or some were moved
    rewrite(to_line(inputs) + "\n" + text.substr(head, size_ - head));
  }
  if (::lseek(file_, 0, SEEK_END) < 0) fail("cannot be appended to");
  if (lines > 0) {
    records = std::move(found);
    return;
  }
  write_line(to_line(inputs));
  for (const Record& record : records) append(record);
}

void Journal::append(const Record& record) {
  write_line(to_line(record));
}

void Journal::restore_if_deleted(const Inputs& inputs, std::span<const Record> records) {
  struct stat ours = {}, there = {};
  if (::stat(path_.c_str(), &there) == 0) {
    const bool is_ours =
        ::fstat(file_, &ours) == 0 && ours.st_dev == there.st_dev && ours.st_ino == there.st_ino;
    if (is_ours) return;
    throw Error(ErrorKind::kFailure,
                fmt::format("{}: is another file now: move it away to go on", path_.string()));
  }
  if (errno != ENOENT) fail("cannot be found");
  std::string text = to_line(inputs) + "\n";
  for (const Record& record : records) text += to_line(record) + "\n";
  rewrite(text);
  if (::lseek(file_, 0, SEEK_END) < 0) fail("cannot be appended to");
}

void Journal::write_line(const std::string& line) {
  const std::string bytes = line + "\n";
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = ::write(file_, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) take_back();
    written += static_cast<std::size_t>(count);
  }
  if (::fdatasync(file_) != 0) take_back();
  size_ += bytes.size();
}

/// Fails with the present errno, without the line that was begun: the next one would join it.
void Journal::take_back() {
  const int why = errno;
  if (::ftruncate(file_, static_cast<off_t>(size_)) == 0) ::lseek(file_, 0, SEEK_END);
  errno = why;
  fail("cannot be written");
}

}  // namespace pcednet::annotate
