#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/row_feeder.h"
#include "pcednet/io/scanners.h"
#include "pcednet/io/text/xyz.h"
#include "pcednet/io/text/xyz_fields.h"
#include "pcednet/io/text/xyz_table.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// A table of quoted numbers is one of points, too, though read_xyz() refuses it without quoted
/// names.
constexpr Separators kAroundNumbers{" \t\r\v\f,;\""};

bool is_number(std::string_view word) {
  return parse_double(word).has_value();
}

/// Under names there may be columns of text among the numbers.
bool may_be_point(const std::vector<std::string_view>& words, bool named) {
  if (named) return std::ranges::count_if(words, is_number) >= 3;
  return words.size() >= 3 && std::all_of(words.begin(), words.begin() + 3, is_number);
}

/// The columns with these names, the first of each; fewer if one is missing.
std::vector<std::size_t> columns_called(const std::vector<std::string>& names,
                                        const std::vector<Column>& columns) {
  std::vector<std::size_t> found;
  for (const std::string& name : names) {
    const auto is_it = [&](const Column& c) { return !c.skip && lower_case(c.name) == name; };
    const auto column = std::ranges::find_if(columns, is_it);
    if (column != columns.end()) {
      found.push_back(static_cast<std::size_t>(column - columns.begin()));
    }
  }
  return found;
}

/// Makes bytes of colours that may not look so in a part of the rows; false if a part may give
/// other colours or labels than all rows.
bool settle_roles(const TableFacts& facts, std::vector<Column>& columns) {
  for (const std::size_t c : columns_called(label_names(), columns)) {
    if (!facts.are_labels(c)) return false;
  }
  for (const std::vector<std::string>& names : colour_names()) {
    const std::vector<std::size_t> colours = columns_called(names, columns);
    if (colours.size() < names.size()) continue;
    const auto are_bytes = [&](std::size_t c) { return facts.are_bytes(c); };
    const auto are_unit = [&](std::size_t c) { return facts.are_up_to_one(c); };
    if (!std::ranges::all_of(colours, are_bytes)) return false;
    if (std::ranges::all_of(colours, are_unit)) return true;  // in every part, too
    for (const std::size_t c : colours) columns[c].type = ScalarType::kUint8;
    return true;
  }
  return true;
}

void put_row(const double* numbers, const std::vector<Column>& columns, std::byte* row) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].type == ScalarType::kUint8) {
      *row++ = static_cast<std::byte>(numbers[c]);
    } else {
      std::memcpy(row, &numbers[c], sizeof(double));
      row += sizeof(double);
    }
  }
}

class XyzPartReader : public PartReader {
 public:
  /// Reads the whole file, to find the parts and what their columns are.
  XyzPartReader(std::unique_ptr<InputFile> file, std::size_t most)
      : file_(std::move(file)), reader_(*file_), most_(most) {
    TableFacts facts;
    while (reader_.next_row()) {
      NumberTable& table = reader_.table();
      if (reader_.place().before % most_ == 0) places_.push_back(reader_.place());
      facts.add({table.row(table.rows() - 1), table.columns()});
      if (table.rows() == kRowsAtOnce) table = NumberTable(table.columns());
    }
    columns_ = reader_.columns(facts);
    warnings = reader_.warnings();
    readable_ = settle_roles(facts, columns_);
    reader_.table() = NumberTable(columns_.size());
  }

  bool readable() const { return readable_; }
  std::size_t points() const override { return reader_.rows(); }
  std::size_t parts() const override { return places_.size(); }

  PointCloud read(std::size_t part) const override {
    TableReader reader = reader_;
    reader.go_to(places_[part]);
    const std::size_t rows = std::min(most_, points() - places_[part].before);
    while (reader.table().rows() < rows && reader.next_row()) continue;
    if (reader.table().rows() < rows) throw unreadable(file_->path(), "is shorter than before");
    CloudBuilder builder(file_->path(), columns_, rows);
    RowFeeder feeder(builder);
    for (std::size_t r = 0; r < rows; ++r) {
      put_row(reader.table().row(r), columns_, feeder.next_row());
    }
    feeder.flush();
    PointCloud cloud = builder.finish().cloud;
    if (part == 0) {
      cloud.comments = reader_.comments();
      cloud.scanners = scanners_of_comments(cloud.comments);
    }
    return cloud;
  }

 private:
  static constexpr std::size_t kRowsAtOnce = 1 << 14;

  std::unique_ptr<InputFile> file_;
  TableReader reader_;  ///< at the end
  std::size_t most_;
  std::vector<Column> columns_ = {};
  std::vector<TableReader::Place> places_ = {};
  bool readable_ = false;
};

}  // namespace

LoadedCloud read_xyz(const InputFile& file) {
  TableReader reader(file);
  while (reader.next_row()) continue;
  NumberTable& table = reader.table();
  TableFacts facts;
  const std::size_t guessed = reader.is_named() ? 0 : table.rows();
  for (std::size_t r = 0; r < guessed; ++r) facts.add({table.row(r), table.columns()});
  CloudBuilder builder(file.path(), reader.columns(facts), table.rows());
  table.move_to(builder);
  LoadedCloud loaded = builder.finish();
  loaded.cloud.comments = reader.comments();
  std::ranges::copy(reader.warnings(), std::back_inserter(loaded.warnings));
  return loaded;
}

std::unique_ptr<PartReader> open_xyz_parts(std::unique_ptr<InputFile> file, std::size_t most) {
  if (is_utf16(file->text(0, 2))) return nullptr;
  auto reader = std::make_unique<XyzPartReader>(std::move(file), most);
  return reader->readable() ? std::move(reader) : nullptr;
}

bool begins_as_points(const InputFile& file) {
  constexpr std::uint64_t kSeen = 1 << 16;
  const std::string text = in_utf8(file.text(0, kSeen));
  const bool is_whole = file.size() <= kSeen;
  std::string_view seen = without_mark(text);
  if (!is_whole) seen = seen.substr(0, seen.find_last_of("\r\n") + 1);
  Lines lines(seen);
  std::string_view line;
  std::vector<std::string_view> words;
  bool named = false, counted = false;
  while (lines.next(line)) {
    line = trim(line);
    if (line.empty() || is_comment(line)) continue;
    split(line, words, kAroundNumbers);
    if (may_be_point(words, named)) return true;
    const bool is_count = !counted && words.size() == 1 && parse_count(words[0]);
    std::vector<std::string> names = split_names(line);
    const bool is_names = !named && name_positions(names);
    if (!is_count && !is_names) return false;
    counted = counted || is_count;
    named = named || is_names;
  }
  return named || !is_whole;
}

}  // namespace pcednet::io
