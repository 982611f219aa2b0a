#include "pcednet/io/text/xyz_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcednet/core/counted.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kMostColumns = 16384;

constexpr Separators kCommasAndSemicolons{",;"}, kSemicolons{";"};

/// The line without the quotes around its numbers. Others stay, so that the error shows them: a
/// comma between quotes may be decimal.
std::string without_quotes(std::string_view line) {
  std::string plain;
  std::size_t at = 0;
  for (;;) {
    const std::size_t begin = line.find('"', at);
    const std::size_t end = begin == std::string_view::npos ? begin : line.find('"', begin + 1);
    if (end == std::string_view::npos) return plain.append(line.substr(at));
    const bool is_apart = (begin == 0 || kNumberSeparators(line[begin - 1])) &&
                          (end + 1 == line.size() || kNumberSeparators(line[end + 1]));
    const std::string_view word = trim(line.substr(begin + 1, end - begin - 1));
    const bool is_number = is_apart && parse_double(word);
    plain.append(line.substr(at, begin - at));
    plain.append(is_number ? word : line.substr(begin, end + 1 - begin));
    at = end + 1;
  }
}

/// Whether `number`, as which the word was read, is another whole number than the word. Doubles
/// hold all of them up to 2^53.
bool is_rounded(std::string_view word, double number) {
  const double size = std::abs(number);
  if (!(size >= 0x1p53 && size < 0x1p64)) return false;
  const auto whole = parse_count(word.substr(word.starts_with('-')));
  return whole && *whole != static_cast<std::uint64_t>(size);
}

}  // namespace

bool TableReader::next_row() {
  std::string_view line;
  for (const std::size_t before = rows_; rows_ == before;) {
    place_ = {lines_.place(), promised_, rows_};
    if (!lines_.next(line)) {
      if (!promised_ || *promised_ == rows_) return false;
      throw unreadable(path_, fmt::format("declares {} points but holds {}", *promised_, rows_));
    }
    take_line(line);
  }
  return true;
}

void TableReader::go_to(const Place& place) {
  lines_.go_to(place.line);
  promised_ = place.promised;
  rows_ = place.before;
}

void TableReader::take_line(std::string_view line) {
  const std::string_view text = trim(line);
  if (text.empty()) return;
  if (separator_ != '\t' || is_comment(text)) line = text;  // else a tab ends a missing entry
  number_ = lines_.number();
  if (quoted_ && !is_comment(line)) line = plain_ = without_quotes(line);
  if (is_comment(line)) {
    take_comment(trim(line.substr(std::min(line.find_first_not_of("#/"), line.size()))));
  } else if (table_.columns() > 0) {
    take_row(line);
  } else {
    take_first(line);
  }
}

void TableReader::take_comment(std::string_view comment) {
  std::vector<std::string> names = split_names(comment);
  const bool may_name = table_.columns() == 0 && names_.empty() && name_positions(names);
  if (may_name) {
    naming_comments_.push_back(comments_.size());
    note_names(comment);
  }
  comments_.emplace_back(comment);
}

/// Whether the line names the columns, which it then does.
bool TableReader::take_names(std::string_view line) {
  std::vector<std::string> names = split_names(line);
  if (!name_positions(names)) return false;
  names_ = std::move(names);
  note_names(line);
  return true;
}

/// Splits the first row. Of the comments that may name columns, the last with as many names as the
/// row has words does; the others are prose that happens to hold x, y and z.
void TableReader::split_first_row(std::string_view line) {
  const bool by_comment = names_.empty();
  for (; by_comment && !naming_comments_.empty(); naming_comments_.pop_back()) {
    const auto comment = comments_.begin() + static_cast<std::ptrdiff_t>(naming_comments_.back());
    take_names(*comment);
    split_row(line);
    if (names_.size() != words_.size()) continue;
    comments_.erase(comment);
    return;
  }
  if (by_comment) names_.clear(), separator_ = 0;
  split_row(line);
}

/// A line before the first point: a count, names, or the first point.
void TableReader::take_first(std::string_view line) {
  split(line, words_, kNumberSeparators);
  if (take_count()) return;
  const bool begins_with_text = names_.empty() && (words_.empty() || !parse_double(words_[0]));
  if (begins_with_text && take_names(line)) {
    quoted_ = line.find('"') != std::string_view::npos;
    return;
  }
  if (begins_with_text && naming_comments_.empty()) {
    throw error(
        "expected numbers, or names of columns with x, y and z (easting, northing and height) "
        "among them");
  }
  decide_on_commas(line);
  split_first_row(line);
  if (words_.size() - empty_words() < 3) throw error("expected at least three numbers");
  if (words_.size() > kMostColumns) {
    throw error(fmt::format("{} numbers: at most {} are read", words_.size(), kMostColumns));
  }
  // A separator at the end of a line begins no column, unless that has a name.
  const bool has_end = words_.back().empty() || names_.size() == words_.size() + 1;
  if (has_end && !names_.empty() && names_.back().empty()) names_.pop_back();
  if (words_.back().empty() && names_.size() < words_.size()) words_.pop_back();
  if (!names_.empty() && names_.size() != words_.size()) {
    throw error(fmt::format("{} numbers under {} names", words_.size(), names_.size()));
  }
  table_ = NumberTable(words_.size());
  entries_.assign(words_.size(), {.are_numbers = names_.empty()});
  for (std::size_t c = 0; c < names_.size(); ++c) {
    entries_[c].are_numbers = names_[c] == "x" || names_[c] == "y" || names_[c] == "z";
  }
  take_row(line);
}

void TableReader::note_names(std::string_view line) {
  const std::size_t first = line.find_first_of(";,\t");
  separator_ = first == std::string_view::npos ? '\0' : line[first];
}

/// A column is of text if the first word in it is no number.
void TableReader::mark_text() {
  if (words_.size() != entries_.size()) return;
  for (std::size_t c = 0; c < words_.size(); ++c) {
    Entries& entries = entries_[c];
    if (entries.are_numbers || entries.are_text || words_[c].empty()) continue;
    (number_of(words_[c]) ? entries.are_numbers : entries.are_text) = true;
  }
}

/// Takes the words for the count of the points that follow, if they can be that: at the
/// beginning, and behind the points of the count before, where a .pts has its next scan.
bool TableReader::take_count() {
  if (words_.size() != 1 || promised_.value_or(0) != rows_) return false;
  const auto count = parse_count(words_[0]);
  if (!count || *count > UINT64_MAX - rows_) return false;
  promised_ = rows_ + *count;
  return true;
}

/// From the first line with commas on, the first unambiguous one decides for the file.
void TableReader::decide_on_commas(std::string_view line) {
  if (commas_ != Commas::kNone) return;
  if (line.find(',') == std::string_view::npos) {
    if (line_with_point_ == 0 && line.find('.') != line.npos) line_with_point_ = number_;
    return;
  }
  FileLines after = lines_;
  deciding_line_ = number_;
  do {
    line = trim(line);
    commas_ = is_comment(line) ? Commas::kNone : commas_of(line);
    if (commas_ == Commas::kDecimals || commas_ == Commas::kSeparators) break;
    deciding_line_ = after.next(line) ? after.number() : 0;
  } while (deciding_line_ != 0);
  if (deciding_line_ == 0) {
    throw error(
        "these commas may be decimal or stand between numbers: separate the numbers by "
        "semicolons, or write decimal points");
  }
  if (commas_ == Commas::kSeparators || line_with_point_ == 0) return;
  number_ = line_with_point_;
  throw decimal_points();
}

Error TableReader::decimal_points() const {
  return error(fmt::format("decimal points, where line {} has decimal commas", deciding_line_));
}

void TableReader::split_row(std::string_view line) {
  split_fields(line, commas_ == Commas::kDecimals ? kSemicolons : kCommasAndSemicolons, words_);
  if (separator_ == 0 || (separator_ != '\t' && words_.size() == names_.size())) return;
  // A text may hold blanks, and between tabs it may be missing: what separates names may alone fit.
  const auto words = static_cast<std::size_t>(std::ranges::count(line, separator_)) + 1;
  if (words != names_.size()) return;
  words_.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator_, begin), line.size());
    words_.push_back(trim(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

/// The numbers of a row between texts, whose commas and points mean nothing; empty without texts.
std::string TableReader::beside_text() const {
  std::string numbers;
  if (words_.size() != entries_.size()) return numbers;
  if (std::ranges::none_of(entries_, &Entries::are_text)) return numbers;
  for (std::size_t c = 0; c < words_.size(); ++c) {
    if (!entries_[c].are_text)
      numbers.append(words_[c]) += commas_ == Commas::kDecimals ? ';' : ',';
  }
  return numbers;
}

std::size_t TableReader::empty_words() const {
  return static_cast<std::size_t>(std::count(words_.begin(), words_.end(), std::string_view()));
}

void TableReader::check_commas(std::string_view line) const {
  const bool in_doubt = commas_ == Commas::kDecimals
                            ? line.find_first_of(",.") != std::string_view::npos
                            : line.find_first_of(" \t;") != std::string_view::npos;
  if (commas_ == Commas::kNone || !in_doubt) return;
  const Commas here = commas_of(line);
  if (commas_ == Commas::kDecimals &&
      (here == Commas::kSeparators || line.find('.') != std::string_view::npos)) {
    const bool has_points = line.find('.') != std::string_view::npos;
    if (has_points && deciding_line_ == number_) {
      const bool is_english = line.find(',') < line.find('.');
      throw error(is_english ? "commas and decimal points: write no commas between thousands"
                             : "points and decimal commas: write no points between thousands");
    }
    if (has_points) throw decimal_points();
    throw error(
        fmt::format("commas between numbers, where line {} has decimal commas", deciding_line_));
  }
  if (commas_ == Commas::kSeparators && here == Commas::kDecimals) {
    throw error(
        fmt::format("decimal commas, where those of line {} separate numbers", deciding_line_));
  }
}

std::optional<double> TableReader::number_of(std::string_view word) const {
  if (word.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (commas_ != Commas::kDecimals) return parse_double(word);
  std::string with_point(word);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parse_double(with_point);
}

void TableReader::take_row(std::string_view line) {
  decide_on_commas(line);
  split_row(line);
  mark_text();
  const std::string numbers = beside_text();
  check_commas(numbers.empty() ? line : numbers);
  if (promised_ && take_count()) return;
  if (words_.size() == table_.columns() + 1 && words_.back().empty()) words_.pop_back();
  if (words_.size() != table_.columns()) {
    throw error(fmt::format("{} where the lines before have {}", counted(words_.size(), "number"),
                            table_.columns()));
  }
  if (empty_words() == words_.size()) return;  // as spreadsheets end a table
  double* const row = table_.add_row();
  ++rows_;
  for (std::size_t c = 0; c < words_.size(); ++c) {
    if (entries_[c].are_text) continue;
    entries_[c].missing += words_[c].empty();
    const auto number = number_of(words_[c]);
    if (!number) throw error(number_fault(words_[c]));
    row[c] = *number;
    entries_[c].rounded += is_rounded(words_[c], *number);
  }
}

TextKind TableReader::kind() const {
  if (extension_of(path_) != ".pts") return TextKind::kAny;
  return promised_ ? TextKind::kCountedPts : TextKind::kPts;
}

std::vector<Column> TableReader::columns(const TableFacts& facts) {
  std::size_t missing = 0;
  for (const Entries& entries : entries_) missing += entries.are_text ? 0 : entries.missing;
  if (missing > 0) {
    warnings_.push_back(
        fmt::format("{} numbers are missing between separators: read as nan", missing));
  }
  if (names_.empty()) guess_names(facts);
  entries_.resize(names_.size());
  std::vector<Column> columns;
  std::vector<std::string> of_text;
  for (std::size_t c = 0; c < names_.size(); ++c) {
    columns.push_back({names_[c].empty() ? fmt::format("scalar_{}", c + 1) : names_[c]});
    columns[c].skip = entries_[c].are_text;
    if (entries_[c].are_text) of_text.push_back(columns[c].name);
    if (entries_[c].rounded == 0) continue;
    warnings_.push_back(fmt::format("column {}: {} whole numbers beyond 2^53 are rounded",
                                    columns[c].name, entries_[c].rounded));
  }
  if (!of_text.empty()) {
    warnings_.push_back(fmt::format("columns of text are left out: {}", fmt::join(of_text, ", ")));
  }
  return columns;
}

void TableReader::guess_names(const TableFacts& facts) {
  names_ = guess_column_names(facts, kind());
  if (names_.size() <= 3) return;
  warnings_.push_back(fmt::format("no column names: read as {}{}", fmt::join(names_, " "),
                                  facts.counts_rows()
                                      ? ", although the first column numbers the points; "
                                        "give names, such as: id x y z"
                                      : ""));
}

}  // namespace pcednet::io
