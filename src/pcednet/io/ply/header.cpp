#include "pcednet/io/ply/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::uint64_t kLongestHeader = std::uint64_t{64} << 20;

std::optional<ScalarType> parse_scalar_type(std::string_view name) {
  static constexpr std::pair<std::string_view, ScalarType> kTypes[] = {
      {"char", ScalarType::kInt8},      {"int8", ScalarType::kInt8},
      {"uchar", ScalarType::kUint8},    {"uint8", ScalarType::kUint8},
      {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},  {"uint16", ScalarType::kUint16},
      {"int", ScalarType::kInt32},      {"int32", ScalarType::kInt32},
      {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
      {"int64", ScalarType::kInt64},    {"uint64", ScalarType::kUint64},
      {"float", ScalarType::kFloat32},  {"float32", ScalarType::kFloat32},
      {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64},
  };
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

/// Cuts header lines off a text. The first line decides how lines end, so that a binary file whose
/// first byte of data is 10 or 13 is cut right.
class HeaderLines {
 public:
  HeaderLines(const std::filesystem::path& path, std::string_view text) : path_(path), text_(text) {
    const std::size_t first = text.find_first_of("\r\n");
    const bool lone_return =
        first != std::string_view::npos && text[first] == '\r' && text.substr(first, 2) != "\r\n";
    end_ = lone_return ? '\r' : '\n';
  }

  std::string_view next() {
    const std::size_t end = text_.find(end_, position_);
    if (end == std::string_view::npos) throw error("the header ends without end_header", 1);
    const std::string_view line = text_.substr(position_, end - position_);
    position_ = end + 1;
    ++number_;
    return trim(line);
  }

  Error error(const std::string& what, std::size_t lines_ahead = 0) const {
    return unreadable(path_, what, number_ + lines_ahead);
  }

  std::size_t position() const { return position_; }
  std::size_t number() const { return number_; }

 private:
  const std::filesystem::path& path_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t number_ = 0;
  char end_;
};

using Words = std::vector<std::string_view>;

PlyEncoding parse_encoding(const Words& words, const HeaderLines& lines) {
  if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
    if (words[1] == "ascii") return PlyEncoding::kAscii;
    if (words[1] == "binary_little_endian") return PlyEncoding::kLittleEndian;
    if (words[1] == "binary_big_endian") return PlyEncoding::kBigEndian;
  }
  throw lines.error("expected format ascii 1.0, binary_little_endian 1.0 or binary_big_endian 1.0");
}

PlyElement parse_element(const Words& words, const HeaderLines& lines) {
  const auto count = words.size() == 3 ? parse_count(words[2]) : std::nullopt;
  if (!count) throw lines.error("expected element <name> <count>");
  PlyElement element;
  element.name = words[1];
  element.count = *count;
  element.text = fmt::format("element {} {}\n", element.name, element.count);
  return element;
}

PlyProperty parse_property(const Words& words, const HeaderLines& lines) {
  const auto type_of = [&](std::string_view name) {
    const auto type = parse_scalar_type(name);
    if (!type) throw lines.error(fmt::format("unknown type {}", name));
    return *type;
  };
  PlyProperty property;
  if (words.size() == 5 && words[1] == "list") {
    property.length_type = type_of(words[2]);
    if (is_floating(*property.length_type)) {
      throw lines.error("the length of a list must be of an integer type");
    }
  } else if (words.size() != 3) {
    throw lines.error("expected property <type> <name> or property list <type> <type> <name>");
  }
  property.type = type_of(words[words.size() - 2]);
  property.name = words.back();
  return property;
}

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.length_type.has_value(); });
}

std::size_t PlyElement::fixed_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) {
    if (!property.length_type) bytes += size_of(property.type);
  }
  return bytes;
}

PlyHeader parse_ply_header(const std::filesystem::path& path, std::string_view text) {
  HeaderLines lines(path, text);
  if (lines.next() != "ply") throw lines.error("not a PLY file: the first line must be ply");
  PlyHeader header;
  bool has_format = false, has_vertex = false;
  Words words;
  for (std::string_view line = lines.next(); line != "end_header"; line = lines.next()) {
    split(line, words);
    if (words.empty()) continue;
    if (words[0] == "comment") {
      header.comments.emplace_back(trim(line.substr(words[0].size())));
    } else if (words[0] == "obj_info") {
      header.comments.emplace_back(line);
    } else if (words[0] == "format") {
      header.encoding = parse_encoding(words, lines);
      has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(words, lines));
      const bool is_vertex = words[1] == "vertex";
      if (is_vertex && has_vertex) throw lines.error("a second element vertex");
      has_vertex = has_vertex || is_vertex;
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(parse_property(words, lines));
      header.elements.back().text += fmt::format("{}\n", line);
    } else {
      throw lines.error(fmt::format(
          "expected format, comment, obj_info, element, property or end_header, not {:.40}",
          words[0]));
    }
  }
  if (!has_format) throw lines.error("the header has no format line");
  header.bytes = lines.position();
  header.lines = lines.number();
  return header;
}

bool begins_as_ply(std::string_view start) {
  return start.starts_with("ply") && start.size() > 3 &&
         (start[3] == '\n' || kBlankSeparators(start[3]));
}

PlyHeader read_ply_header(const InputFile& file) {
  if (!begins_as_ply(file.text(0, 4))) {
    throw unreadable(file.path(), "not a PLY file: the first line must be ply");
  }
  std::uint64_t length = std::min(file.size(), std::uint64_t{64} << 10);
  std::string text = file.text(0, length);
  while (text.find("end_header") == std::string::npos && length < file.size() &&
         length < kLongestHeader) {
    length = std::min(file.size(), 2 * length);
    text = file.text(0, length);
  }
  // A comment may hold the word, and the line's end may lie beyond the part read so far.
  if (length < file.size()) text += file.text(length, std::uint64_t{64} << 10);
  return parse_ply_header(file.path(), text);
}

std::string_view ply_type_name(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
      return "char";
    case ScalarType::kUint8:
      return "uchar";
    case ScalarType::kInt16:
      return "short";
    case ScalarType::kUint16:
      return "ushort";
    case ScalarType::kInt32:
      return "int";
    case ScalarType::kUint32:
      return "uint";
    case ScalarType::kFloat32:
      return "float";
    case ScalarType::kInt64:
    case ScalarType::kUint64:
    case ScalarType::kFloat64:
      break;
  }
  return "double";
}

}  // namespace pcednet::io
