#include "pcednet/io/las/comments.h"

#include <algorithm>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
std::optional<LasRecord> las_comment_record(const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += comment + "\n";
  if (text.empty() || text.size() > UINT16_MAX) return std::nullopt;
  return new_record(kCommentsRecord, "comments", std::move(text));
}

std::vector<std::string> take_las_comments(LasFile& file) {
  std::vector<std::string> comments;
  for (LasRecord& record : file.records) {
    if (!record.is(kCommentsRecord)) continue;
    std::string text = std::move(record.data);
    std::replace_if(
        text.begin(), text.end(),
        [](unsigned char c) { return c != '\n' && (c < ' ' || c == 127); }, ' ');
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) comments.emplace_back(line);
  }
  std::erase_if(file.records, [](const LasRecord& r) { return r.is(kCommentsRecord); });
  return comments;
}

}  // namespace pcednet::io
