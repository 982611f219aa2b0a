#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/file_lines.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/text/number_table.h"
#include "pcednet/io/text/xyz_fields.h"

namespace pcednet::io {

/// The lines of a text of points, row by row: see read_xyz(). A copy goes on by itself; the file
/// must outlive both.
class TableReader {
 public:
  explicit TableReader(const InputFile& file) : path_(file.path()), lines_(file) {}

  /// Adds the next row to the table; false at the end of the file. Throws Error(kUnreadable) for a
  /// line that does not fit the others.
  bool next_row();

  NumberTable& table() { return table_; }
  std::size_t rows() const { return rows_; }  ///< that were read, also those no longer in table()

  /// The place of the row that next_row() gave last.
  struct Place {
    FileLines::Place line;
    std::optional<std::uint64_t> promised;  ///< points up to the end of its scan
    std::size_t before = 0;                 ///< rows
  };
  Place place() const { return place_; }
  /// Goes on with the row at a place that another reader of the file gave, of which this is a copy.
  void go_to(const Place& place);

  bool is_named() const { return !names_.empty(); }
  /// The columns, once all rows were read; of these are `facts`, which only guesses of names need.
  std::vector<Column> columns(const TableFacts& facts);
  const std::vector<std::string>& comments() const { return comments_; }
  /// The warnings to the user, once columns() was called.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, number_); }
  void take_line(std::string_view line);
  void take_comment(std::string_view comment);
  void take_first(std::string_view line);
  bool take_names(std::string_view line);
  void split_first_row(std::string_view line);
  void note_names(std::string_view line);
  void mark_text();
  bool take_count();
  void decide_on_commas(std::string_view line);
  Error decimal_points() const;
  void split_row(std::string_view line);
  std::string beside_text() const;
  std::size_t empty_words() const;
  void check_commas(std::string_view line) const;
  std::optional<double> number_of(std::string_view word) const;
  void take_row(std::string_view line);
  void guess_names(const TableFacts& facts);
  TextKind kind() const;

  const std::filesystem::path& path_;
  FileLines lines_;
  std::size_t number_ = 0;
  std::vector<std::string> names_ = {};
  std::vector<std::size_t> naming_comments_ = {};  ///< that may name the columns, by number
  char separator_ = 0;                             ///< between the names; 0: blanks
  bool quoted_ = false;     ///< the line of names has quotes, so that numbers may have them
  std::string plain_ = {};  ///< the line at hand without them
  std::vector<std::string> comments_ = {}, warnings_ = {};
  std::vector<std::string_view> words_ = {};
  std::optional<std::uint64_t> promised_ = {};
  Commas commas_ = Commas::kNone;  ///< those of all lines
  std::size_t deciding_line_ = 0;
  std::size_t line_with_point_ = 0;  ///< the first, before commas
  /// The words of a column.
  struct Entries {
    bool are_numbers = false, are_text = false;  ///< neither: none is there so far
    std::size_t missing = 0, rounded = 0;
  };
  std::vector<Entries> entries_ = {};
  NumberTable table_ = NumberTable(0);
  std::size_t rows_ = 0;
  Place place_ = {};
};

}  // namespace pcednet::io
