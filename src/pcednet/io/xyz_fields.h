#pragma once

#include <string_view>
#include <vector>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {

/// Replaces `fields` by the parts of `line` between blanks and `separators` (commas, semicolons).
/// A field is empty where only blanks are between two of the latter, before the first or behind the
/// last: 1,,3 has three fields, 1,2, too.
void split_fields(std::string_view line, const Separators& separators,
                  std::vector<std::string_view>& fields);

}  // namespace pcednet::io
