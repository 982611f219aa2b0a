#include "pcednet/io/xyz_fields.h"

namespace pcednet::io {

void split_fields(std::string_view line, const Separators& separators,
                  std::vector<std::string_view>& fields) {
  fields.clear();
  bool is_due = true;  // a field, since the last separator or the beginning
  std::size_t at = 0;
  while (at < line.size()) {
    const std::size_t begin = at;
    while (at < line.size() && !separators(line[at]) && !kBlankSeparators(line[at])) ++at;
    if (at > begin) {
      fields.push_back(line.substr(begin, at - begin));
      is_due = false;
      continue;
    }
    if (separators(line[at++])) {
      if (is_due) fields.emplace_back();
      is_due = true;
    }
  }
  if (is_due && !line.empty()) fields.emplace_back();
}

}  // namespace pcednet::io
