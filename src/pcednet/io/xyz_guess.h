#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pcednet/io/number_table.h"

namespace pcednet::io {

/// Whether the vector at `n` has about unit length.
bool looks_like_normal(const double* n);

/// Whether the first column is n, n + 1, n + 2, ... in four rows or more.
bool counts_rows(const NumberTable& table);

/// The columns of a text file, guessed from its extension and first line.
enum class TextKind { kAny, kPts, kCountedPts };

/// Names for the columns of a table without names: x y z; then, from the left, three columns of
/// unit vectors are normals and three of whole numbers in 0 ... 255 colours; a last one that holds
/// only 0, 1, 2 and 255 is the label; any other column c (from 1) is scalar_c. In a .pts the fourth
/// is the intensity if it stands alone or before colours; where the file begins with a count, as it
/// should, even if it or the last channel could be labels.
std::vector<std::string> guess_column_names(const NumberTable& table,
                                            TextKind kind = TextKind::kAny);

}  // namespace pcednet::io
