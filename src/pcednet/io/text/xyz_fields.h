#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {

/// Replaces `fields` by the parts of `line` between blanks and `separators` (commas, semicolons).
/// A field is empty where only blanks are between two of the latter, before the first or behind the
/// last: 1,,3 has three fields, 1,2, too.
void split_fields(std::string_view line, const Separators& separators,
                  std::vector<std::string_view>& fields);

/// The meaning of the commas in a line of numbers.
enum class Commas { kNone, kSeparators, kDecimals, kUnclear };

/// Commas are decimal beside semicolons (1,5;2,5), and within three or more words of at most one
/// each (1,5 2,25 3). They separate numbers in a line without blanks, next to a blank (1, 2 ,3),
/// and where a word has two (1,2,3 255). Unclear are lines that read either way, such as 1,5, 2,5,
/// 3,5 or 1,5 2 or 1.234,5 1,0 2,0.
Commas commas_of(std::string_view line);

/// The names in a line of names; those of a .csv may hold blanks.
std::vector<std::string> split_names(std::string_view line);

/// Whether there are columns for positions, in any case: x, y and z, or the names that surveyors
/// use in place of these, which then become x, y and z.
///
/// The names are easting or rechtswert; northing or hochwert; and z, elevation, altitude, height,
/// höhe or hoehe, in this order where there are several. E, n and h count if none of the others is
/// there. Beside an x or a y they are columns like any other. A unit of length in brackets may
/// follow: x [m].
bool name_positions(std::vector<std::string>& names);

/// Whether the vector at `n` has about unit length.
bool looks_like_normal(const double* n);

/// The values in the columns of a table, row by row.
class TableFacts {
 public:
  void add(std::span<const double> row);

  std::size_t columns() const { return columns_.size(); }
  /// Facts on a column: whether no number is above 1; whether there are rows, and all hold whole
  /// numbers in 0 ... 255; those or other labels, see to_label(); 0, 1, 2 and 255 alone.
  bool are_up_to_one(std::size_t column) const { return columns_[column].are_up_to_one; }
  bool are_bytes(std::size_t column) const { return rows_ > 0 && columns_[column].are_bytes; }
  bool are_labels(std::size_t column) const { return rows_ > 0 && columns_[column].are_labels; }
  bool are_classes(std::size_t column) const { return rows_ > 0 && columns_[column].are_classes; }
  /// Whether three columns are unit vectors in nine rows of ten.
  bool are_normals(std::size_t first) const;
  /// Whether the first column is n, n + 1, n + 2, ... in four rows or more.
  bool counts_rows() const { return rows_ > 3 && counts_; }

 private:
  struct Column {
    bool are_up_to_one = true, are_bytes = true, are_labels = true, are_classes = true;
    std::size_t unit = 0;  ///< vectors that begin here
  };
  std::vector<Column> columns_ = {};
  std::size_t rows_ = 0;
  bool counts_ = true;
  double next_ = 0.0;
};

/// The columns of a text file, guessed from its extension and first line.
enum class TextKind { kAny, kPts, kCountedPts };

/// Names for the columns of a table without names: x y z; then, from the left, three columns of
/// unit vectors are normals and three of whole numbers in 0 ... 255 colours; a last one that holds
/// only 0, 1, 2 and 255 is the label; any other column c (from 1) is scalar_c. In a .pts the fourth
/// is the intensity if it stands alone or before colours; where the file begins with a count, as it
/// should, even if it or the last channel could be labels.
std::vector<std::string> guess_column_names(const TableFacts& facts,
                                            TextKind kind = TextKind::kAny);

}  // namespace pcednet::io
