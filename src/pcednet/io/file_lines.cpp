#include "pcednet/io/file_lines.h"

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::uint64_t kBytesAtOnce = 1 << 20;

}  // namespace

FileLines::FileLines(const InputFile& file) : file_(&file) {
  if (is_utf16(file.text(0, 2))) {
    text_ = in_utf8(file.text());
    read_ = file.size();
  } else {
    read_more();
  }
  next_ = text_.size() - without_mark(text_).size();
}

void FileLines::go_to(const Place& place) {
  read_ = place.byte;
  number_ = place.lines_before;
  text_.clear();
  next_ = 0;
}

/// Forgets the lines that were given, and reads more of the file; false at its end.
bool FileLines::read_more() {
  text_.erase(0, next_);
  next_ = 0;
  const std::string more = file_->text(read_, kBytesAtOnce);
  read_ += more.size();
  text_ += more;
  return !more.empty();
}

/// The end of a line, not before `from`. Lines end with \r where the first end is none of \n.
std::size_t FileLines::find_end(std::size_t from) {
  if (end_ == 0 && text_.find('\n', from) != std::string::npos) end_ = '\n';
  if (end_ == 0 && text_.find('\r', from) != std::string::npos) end_ = '\r';
  return end_ == 0 ? std::string::npos : text_.find(end_, from);
}

bool FileLines::next(std::string_view& line) {
  std::size_t end = find_end(next_);
  while (end == std::string::npos) {
    const std::size_t searched = text_.size() - next_;
    if (!read_more()) break;
    end = find_end(searched);
  }
  if (next_ == text_.size()) return false;
  line = std::string_view(text_).substr(next_, end == std::string::npos ? end : end - next_);
  next_ = end == std::string::npos ? text_.size() : end + 1;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return true;
}

bool FileLines::next_filled(std::string_view& line) {
  while (next(line)) {
    if (!trim(line).empty()) return true;
  }
  return false;
}

}  // namespace pcednet::io
