#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/ply.h"
#include "pcednet/io/ply_header.h"
#include "pcednet/io/ply_rows.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/row_feeder.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

bool is_vertex(const PlyElement& element) {
  return element.name == "vertex";
}

std::vector<Column> scalar_columns(const PlyElement& vertex) {
  std::vector<Column> columns;
  for (const PlyProperty& property : vertex.properties) {
    if (!property.length_type) columns.push_back({property.name, property.type});
  }
  return columns;
}

/// Bytes that a row has at least: its lists may be empty.
std::size_t least_row_bytes(const PlyElement& element, bool ascii) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += ascii ? 2 : size_of(property.length_type.value_or(property.type));
  }
  return bytes;
}

void check_fits(const InputFile& file, const PlyElement& element, std::uint64_t offset,
                bool ascii) {
  const std::size_t row = least_row_bytes(element, ascii);
  // The last line may lack its end.
  const std::uint64_t left = file.size() - offset + (ascii ? 1 : 0);
  if (row != 0 && element.count > left / row) {
    throw unreadable(file.path(),
                     fmt::format("promises {} rows of element {}, of {} bytes or more each, but "
                                 "ends {} bytes after byte {}",
                                 element.count, element.name, row, file.size() - offset, offset));
  }
}

/// Reads the elements of a binary body one after the other.
class BinaryBody {
 public:
  BinaryBody(const InputFile& file, const PlyHeader& header)
      : file_(file), offset_(header.bytes), swap_(header.encoding == PlyEncoding::kBigEndian) {}

  std::uint64_t offset() const { return offset_; }
  std::uint64_t unread() const { return file_.size() - offset_; }

  void read_vertices(const PlyElement& vertex, const std::vector<Column>&, CloudBuilder& builder) {
    if (vertex.has_lists()) {
      read_list_vertices(vertex, builder);
      return;
    }
    const std::size_t row = vertex.fixed_bytes();
    const std::size_t block = std::max<std::size_t>(1, (std::size_t{1} << 19) / row);
    parallel_blocks(builder.size(), block, [&](std::size_t begin, std::size_t end) {
      const std::size_t bytes = (end - begin) * row;
      const auto rows = std::make_unique_for_overwrite<std::byte[]>(bytes);
      file_.read(offset_ + begin * row, {rows.get(), bytes});
      if (swap_) walk(vertex, end - begin, rows.get(), rows.get() + bytes, ignore);
      builder.fill_rows(rows.get(), begin, end);
    });
    offset_ += builder.size() * row;
  }

  std::vector<std::byte> read_foreign(const PlyElement& element) {
    if (element.properties.empty() || element.count == 0) return {};
    if (!element.has_lists()) {
      std::vector<std::byte> bytes(element.count * element.fixed_bytes());
      file_.read(offset_, bytes);
      if (swap_) walk(element, element.count, bytes.data(), bytes.data() + bytes.size(), ignore);
      offset_ += bytes.size();
      return bytes;
    }
    const std::span<std::byte> left = tail();
    std::byte* const end =
        walk(element, element.count, left.data(), left.data() + left.size(), ignore);
    offset_ += static_cast<std::uint64_t>(end - left.data());
    return {left.data(), end};
  }

 private:
  static void ignore(std::size_t, const std::byte*, ScalarType, bool) {}

  /// Walks `count` rows; throws if they do not end before `end`.
  template <typename Visit>
  std::byte* walk(const PlyElement& element, std::uint64_t count, std::byte* begin,
                  const std::byte* end, Visit&& visit) const {
    std::byte* row = begin;
    for (std::uint64_t i = 0; i < count; ++i) {
      std::byte* const next = walk_ply_row(element, row, end, swap_, visit);
      if (!next) {
        throw unreadable(file_.path(),
                         fmt::format("byte {}: row {} of {} of element {} is broken or cut off",
                                     offset_ + static_cast<std::uint64_t>(row - begin), i + 1,
                                     element.count, element.name));
      }
      row = next;
    }
    return row;
  }

  void read_list_vertices(const PlyElement& vertex, CloudBuilder& builder) {
    if (vertex.count == 0) return;
    const std::span<std::byte> left = tail();
    RowFeeder feeder(builder);
    std::byte* row = left.data();
    const std::byte* const end = left.data() + left.size();
    for (std::uint64_t i = 0; i < vertex.count; ++i) {
      std::byte* packed = feeder.next_row();
      const auto keep = [&](std::size_t p, const std::byte* number, ScalarType type, bool) {
        if (vertex.properties[p].length_type) return;
        std::memcpy(packed, number, size_of(type));
        packed += size_of(type);
      };
      row = walk(vertex, 1, row, end, keep);
    }
    feeder.flush();
    offset_ += static_cast<std::uint64_t>(row - left.data());
  }

  /// The file from `offset_` to its end, in memory.
  std::span<std::byte> tail() {
    if (tail_.empty()) {
      tail_offset_ = offset_;
      tail_.resize(file_.size() - offset_);
      file_.read(offset_, tail_);
    }
    return std::span(tail_).subspan(offset_ - tail_offset_);
  }

  const InputFile& file_;
  std::uint64_t offset_;
  bool swap_;
  std::vector<std::byte> tail_;
  std::uint64_t tail_offset_ = 0;
};

/// Reads the elements of an ascii body, one row a line.
class AsciiBody {
 public:
  AsciiBody(const InputFile& file, const PlyHeader& header)
      : path_(file.path()),
        offset_(header.bytes),
        text_(file.text(header.bytes)),
        lines_(text_, header.lines) {}

  /// Where the first row of all begins.
  std::uint64_t offset() const { return offset_; }

  /// `columns` are the scalar properties, with the types to read them in.
  void read_vertices(const PlyElement& vertex, const std::vector<Column>& columns,
                     CloudBuilder& builder) {
    RowFeeder feeder(builder);
    for (std::uint64_t i = 0; i < vertex.count; ++i) {
      std::byte* packed = feeder.next_row();
      auto column = columns.begin();
      read_row(vertex, [&](std::size_t p, ScalarType type, std::string_view word, bool) {
        std::byte skipped[8];
        if (vertex.properties[p].length_type) return parse(word, type, skipped);
        parse(word, column->type, packed);
        packed += size_of(column->type);
        ++column;
      });
    }
    feeder.flush();
  }

  std::vector<std::byte> read_foreign(const PlyElement& element) {
    std::vector<std::byte> bytes;
    if (element.properties.empty()) return bytes;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element, [&](std::size_t, ScalarType type, std::string_view word, bool) {
        std::byte number[8];
        parse(word, type, number);
        bytes.insert(bytes.end(), number, number + size_of(type));
      });
    }
    return bytes;
  }

  /// Bytes after the rows read so far, but for blank lines between.
  std::uint64_t unread() {
    std::string_view line;
    while (lines_.next(line)) {
      if (!trim(line).empty())
        return text_.size() - static_cast<std::size_t>(line.data() - text_.data());
    }
    return 0;
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, lines_.number()); }

  void parse(std::string_view word, ScalarType type, std::byte* number) const {
    if (parse_number(word, type, number)) return;
    throw error(fmt::format("expected a number of type {}, not {:.40}", ply_type_name(type), word));
  }

  /// Calls `take(property, type, word, is_length)` for the words of the next line.
  template <typename Take>
  void read_row(const PlyElement& element, Take&& take) {
    std::string_view line;
    do {
      if (!lines_.next(line)) {
        throw error(fmt::format("the file ends within element {}, which promises {} rows",
                                element.name, element.count));
      }
    } while (trim(line).empty());
    split(line, words_);
    std::size_t used = 0;
    const auto next_word = [&] {
      if (used == words_.size()) throw error("too few numbers for a row of " + element.name);
      return words_[used++];
    };
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      std::uint64_t numbers = 1;
      if (property.length_type) {
        const std::string_view word = next_word();
        const auto length = parse_count(word);
        if (!length) throw error(fmt::format("expected the length of a list, not {:.40}", word));
        take(p, *property.length_type, word, true);
        numbers = *length;
      }
      for (std::uint64_t i = 0; i < numbers; ++i) take(p, property.type, next_word(), false);
    }
    if (used != words_.size()) throw error("too many numbers for a row of " + element.name);
  }

  const std::filesystem::path& path_;
  std::uint64_t offset_;
  std::string text_;
  Lines lines_;
  std::vector<std::string_view> words_;
};

void check_has_vertices(const InputFile& file, const PlyHeader& header) {
  if (std::any_of(header.elements.begin(), header.elements.end(), is_vertex)) return;
  std::string names;
  for (const PlyElement& element : header.elements) names += " " + element.name;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: points are read from an element vertex; there is{}",
                          file.path().string(), names.empty() ? " no element" : names));
}

/// Reads all elements from `body`, float positions as double if `wide`.
template <typename Body>
LoadedCloud read_elements(const InputFile& file, const PlyHeader& header, Body&& body, bool wide) {
  LoadedCloud loaded;
  std::vector<ForeignElement> foreign;
  for (const PlyElement& element : header.elements) {
    check_fits(file, element, body.offset(), header.encoding == PlyEncoding::kAscii);
    if (!is_vertex(element)) {
      foreign.push_back({element.text, body.read_foreign(element)});
      continue;
    }
    std::vector<Column> columns = scalar_columns(element);
    if (wide) widen_positions(columns);
    CloudBuilder builder(file.path(), columns, element.count);
    body.read_vertices(element, columns, builder);
    loaded = builder.finish();
    if (element.has_lists()) {
      loaded.warnings.emplace_back("lists in the element vertex are not kept");
    }
  }
  if (const std::uint64_t unread = body.unread(); unread > 0) {
    loaded.warnings.push_back(fmt::format("{} bytes after the last element were not read", unread));
  }
  loaded.cloud.foreign_elements = std::move(foreign);
  loaded.cloud.comments = header.comments;
  return loaded;
}

}  // namespace

LoadedCloud read_ply(const InputFile& file) {
  const PlyHeader header = read_ply_header(file);
  check_has_vertices(file, header);
  if (header.encoding != PlyEncoding::kAscii) {
    return read_elements(file, header, BinaryBody(file, header), false);
  }
  return keep_spelled_digits(read_elements(file, header, AsciiBody(file, header), false), [&] {
    return read_elements(file, header, AsciiBody(file, header), true);
  });
}

}  // namespace pcednet::io
