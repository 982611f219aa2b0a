#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/xyz.h"
#include "pcednet/io/xyz_guess.h"

namespace pcednet::io {
namespace {

constexpr Separators kAllSeparators{" \t\r\v\f,;"};
// Beside semicolons a comma could only be a decimal one, which is then reported.
constexpr Separators kSemicolonSeparators{" \t\r\v\f;"};

/// The names in a line of names; those of a .csv may hold blanks.
std::vector<std::string> split_names(std::string_view line) {
  std::vector<std::string> names;
  const std::size_t separator = line.find_first_of(";,\t");
  if (separator == std::string_view::npos) {
    std::vector<std::string_view> words;
    split(line, words);
    names.assign(words.begin(), words.end());
  } else {
    const char mark = line[separator];
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(mark, begin), line.size());
      names.emplace_back(trim(line.substr(begin, end - begin)));
      begin = end + 1;
    }
  }
  for (std::string& name : names) std::erase(name, '"');
  return names;
}

bool names_positions(const std::vector<std::string>& names) {
  const auto has = [&](std::string_view wanted) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return lower_case(name) == wanted; });
  };
  return has("x") && has("y") && has("z");
}

class TableReader {
 public:
  explicit TableReader(const InputFile& file) : path_(file.path()), text_(file.text()) {}

  LoadedCloud read() {
    Lines lines(text_.starts_with("\xEF\xBB\xBF") ? std::string_view(text_).substr(3) : text_);
    std::string_view line;
    while (lines.next(line)) {
      line = trim(line);
      if (line.empty()) continue;
      number_ = lines.number();
      if (line.starts_with('#') || line.starts_with("//")) {
        take_comment(trim(line.substr(std::min(line.find_first_not_of("#/"), line.size()))));
      } else if (table_.columns > 0) {
        take_row(line);
      } else {
        take_first(line);
      }
    }
    if (promised_ && *promised_ != table_.rows()) {
      throw unreadable(path_,
                       fmt::format("promises {} points but holds {}", *promised_, table_.rows()));
    }
    return build();
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, number_); }

  void take_comment(std::string_view comment) {
    std::vector<std::string> names = split_names(comment);
    if (table_.columns == 0 && names_.empty() && names_positions(names)) {
      names_ = std::move(names);
      naming_comment_ = comment;
    } else {
      comments_.emplace_back(comment);
    }
  }

  /// A line before the first point: a count, names, or the first point.
  void take_first(std::string_view line) {
    separators_ =
        line.find(';') == std::string_view::npos ? &kAllSeparators : &kSemicolonSeparators;
    split(line, words_, *separators_);
    if (words_.size() == 1 && !promised_ && parse_count(words_[0])) {
      promised_ = parse_count(words_[0]);
      return;
    }
    const bool is_number = !words_.empty() && parse_double(words_[0]).has_value();
    if (!is_number && names_.empty()) {
      names_ = split_names(line);
      if (names_positions(names_)) return;
      throw error("expected numbers, or names of columns with x, y and z among them");
    }
    if (words_.size() < 3) throw error("expected at least three numbers");
    if (!naming_comment_.empty() && names_.size() != words_.size()) {
      comments_.push_back(naming_comment_);  // prose that happens to hold x, y and z
      names_.clear();
    }
    if (!names_.empty() && names_.size() != words_.size()) {
      throw error(fmt::format("{} numbers under {} names", words_.size(), names_.size()));
    }
    table_.columns = words_.size();
    take_row(line);
  }

  void take_row(std::string_view line) {
    split(line, words_, *separators_);
    if (words_.size() != table_.columns) {
      throw error(
          fmt::format("{} numbers where the lines before have {}", words_.size(), table_.columns));
    }
    for (const std::string_view word : words_) {
      const auto number = parse_double(word);
      if (!number) throw error(fmt::format("expected a number, not {:.40}", word));
      table_.numbers.push_back(*number);
    }
  }

  LoadedCloud build() {
    const bool guessed = names_.empty();
    if (guessed) names_ = guess_column_names(table_);
    std::vector<Column> columns;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      columns.push_back({names_[c].empty() ? fmt::format("scalar_{}", c + 1) : names_[c]});
    }
    CloudBuilder builder(path_, columns, table_.rows());
    builder.fill_rows(reinterpret_cast<const std::byte*>(table_.numbers.data()), 0, table_.rows());
    LoadedCloud loaded = builder.finish();
    loaded.cloud.comments = std::move(comments_);
    if (guessed && table_.columns > 3) {
      loaded.warnings.push_back(
          fmt::format("no names of columns: taken as {}", fmt::join(names_, " ")));
    }
    return loaded;
  }

  const std::filesystem::path& path_;
  std::string text_;
  std::size_t number_ = 0;
  std::vector<std::string> names_;
  std::string naming_comment_;  ///< the comment that the names come from, if they do
  std::vector<std::string> comments_;
  std::vector<std::string_view> words_;
  std::optional<std::uint64_t> promised_;
  const Separators* separators_ = &kAllSeparators;
  NumberTable table_;
};

}  // namespace

LoadedCloud read_xyz(const InputFile& file) {
  return TableReader(file).read();
}

}  // namespace pcednet::io
