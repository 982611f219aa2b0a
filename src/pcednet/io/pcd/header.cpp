#include "pcednet/io/pcd/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "pcednet/io/pcd/pcd.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::uint64_t kLongestPcdHeader = std::uint64_t{1} << 20;
/// More numbers in one field than any descriptor has; keeps sums of sizes from overflowing.
constexpr std::uint64_t kMostCount = std::uint64_t{1} << 20;

using PcdWords = std::vector<std::string_view>;

std::optional<ScalarType> parse_type(std::string_view kind, std::string_view size) {
  if (kind == "F" && size == "4") return ScalarType::kFloat32;
  if (kind == "F" && size == "8") return ScalarType::kFloat64;
  const bool is_signed = kind == "I";
  if (!is_signed && kind != "U") return std::nullopt;
  if (size == "1") return is_signed ? ScalarType::kInt8 : ScalarType::kUint8;
  if (size == "2") return is_signed ? ScalarType::kInt16 : ScalarType::kUint16;
  if (size == "4") return is_signed ? ScalarType::kInt32 : ScalarType::kUint32;
  if (size == "8") return is_signed ? ScalarType::kInt64 : ScalarType::kUint64;
  return std::nullopt;
}

class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view text)
      : path_(path), text_(text) {}

  PcdHeader parse() {
    while (next_line()) {
      if (line_.starts_with('#')) {
        const std::string_view comment = trim(line_.substr(1));
        const bool is_magic = header_.lines == 1 && comment.starts_with(".PCD");
        if (!is_magic) header_.comments.emplace_back(comment);
        continue;
      }
      split(line_, words_);
      if (words_.empty()) continue;
      take_entry(words_[0]);
      if (words_[0] == "DATA") return finish();
    }
    throw error("the header ends without DATA");
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, header_.lines); }

  bool next_line() {
    const std::size_t end = text_.find('\n', header_.bytes);
    if (end == std::string_view::npos) return false;
    line_ = trim(text_.substr(header_.bytes, end - header_.bytes));
    header_.bytes = end + 1;
    ++header_.lines;
    return true;
  }

  void take_entry(std::string_view key) {
    const auto rest = [&] { return std::vector<std::string>(words_.begin() + 1, words_.end()); };
    if (key == "VERSION") return;
    if (key == "FIELDS" || key == "COLUMNS") {
      names_ = rest();
    } else if (key == "SIZE") {
      sizes_ = rest();
    } else if (key == "TYPE") {
      types_ = rest();
    } else if (key == "COUNT") {
      counts_ = rest();
    } else if (key == "WIDTH") {
      width_ = take_count();
    } else if (key == "HEIGHT") {
      header_.height = take_count();
    } else if (key == "POINTS") {
      points_ = take_count();
    } else if (key == "VIEWPOINT") {
      take_viewpoint();
    } else if (key == "DATA") {
      take_encoding();
    } else {
      throw error(fmt::format("not a line of a PCD header: {:.40}", line_));
    }
  }

  std::uint64_t take_count() const {
    const auto count = words_.size() == 2 ? parse_count(words_[1]) : std::nullopt;
    if (!count) throw error(fmt::format("expected {} <count>", words_[0]));
    return *count;
  }

  void take_viewpoint() {
    bool is_origin = words_.size() == 8;
    for (std::size_t i = 1; i < words_.size() && is_origin; ++i) {
      is_origin = parse_double(words_[i]) == (i == 4 ? 1.0 : 0.0);
    }
    if (!is_origin) header_.comments.emplace_back(line_);
  }

  void take_encoding() {
    const std::string_view name = words_.size() == 2 ? words_[1] : "";
    if (name == "ascii") {
      header_.encoding = PcdEncoding::kAscii;
    } else if (name == "binary") {
      header_.encoding = PcdEncoding::kBinary;
    } else if (name == "binary_compressed") {
      header_.encoding = PcdEncoding::kCompressed;
    } else {
      throw error("expected DATA ascii, binary or binary_compressed");
    }
  }

  PcdHeader finish() {
    if (names_.empty()) throw error("the header has no FIELDS");
    if (counts_.empty()) counts_.assign(names_.size(), "1");
    if (sizes_.size() != names_.size() || types_.size() != names_.size() ||
        counts_.size() != names_.size()) {
      throw error(fmt::format("{} FIELDS with {} SIZE, {} TYPE and {} COUNT", names_.size(),
                              sizes_.size(), types_.size(), counts_.size()));
    }
    for (std::size_t f = 0; f < names_.size(); ++f) {
      const auto type = parse_type(types_[f], sizes_[f]);
      const auto count = parse_count(counts_[f]);
      if (!type || !count || *count == 0 || *count > kMostCount) {
        throw error(fmt::format("field {}: no type {} of {} bytes, {} times", names_[f], types_[f],
                                sizes_[f], counts_[f]));
      }
      header_.fields.push_back({names_[f], *type, *count, names_[f] == "_"});
    }
    finish_size();
    return std::move(header_);
  }

  void finish_size() {
    if (!width_ && !points_) throw error("the header has neither WIDTH nor POINTS");
    header_.width = width_.value_or(points_.value_or(0));
    if (!width_) header_.height = 1;
    header_.points = points_.value_or(0);
    const bool overflows = header_.height != 0 && header_.width > UINT64_MAX / header_.height;
    if (!points_ && !overflows) header_.points = header_.width * header_.height;
    if (overflows || header_.points != header_.width * header_.height) {
      throw error(fmt::format("WIDTH {} times HEIGHT {} is not POINTS {}", header_.width,
                              header_.height, header_.points));
    }
    if (header_.height > 1) {
      header_.comments.push_back(fmt::format("WIDTH {} HEIGHT {}", header_.width, header_.height));
    }
  }

  const std::filesystem::path& path_;
  std::string_view text_;
  std::string_view line_;
  PcdWords words_;
  std::vector<std::string> names_, sizes_, types_, counts_;
  std::optional<std::uint64_t> width_, points_;
  PcdHeader header_;
};

}  // namespace

std::size_t PcdHeader::row_bytes() const {
  std::size_t sum = 0;
  for (const Column& field : fields) sum += field.count * size_of(field.type);
  return sum;
}

std::size_t PcdHeader::numbers_per_point() const {
  std::size_t numbers = 0;
  for (const Column& field : fields) numbers += field.count;
  return numbers;
}

bool begins_as_pcd(std::string_view start) {
  if (start.starts_with("# .PCD")) return true;
  while (start.starts_with('#')) {
    const std::size_t end = start.find('\n');
    start.remove_prefix(end == start.npos ? start.size() : end + 1);
  }
  return start.starts_with("VERSION ") || start.starts_with("FIELDS ");
}

PcdHeader read_pcd_header(const InputFile& file) {
  const std::string text = file.text(0, kLongestPcdHeader);
  if (!begins_as_pcd(text)) {
    throw unreadable(file.path(), "not a PCD file: no header with VERSION and FIELDS", 1);
  }
  return HeaderParser(file.path(), text).parse();
}

}  // namespace pcednet::io
