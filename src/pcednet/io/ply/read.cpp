#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/ply/body.h"
#include "pcednet/io/ply/header.h"
#include "pcednet/io/ply/ply.h"
#include "pcednet/io/ply/rows.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/row_feeder.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// Reads the elements of an ascii body, one row a line.
class AsciiBody {
 public:
  AsciiBody(const InputFile& file, const PlyHeader& header)
      : path_(file.path()),
        offset_(header.bytes),
        text_(file.text(header.bytes)),
        lines_(text_, header.lines) {}

  /// The offset of the very first row.
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

  /// Bytes after the rows read so far, without blank lines between.
  std::uint64_t unread() { return lines_.unread(); }

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
    if (!lines_.next_filled(line)) {
      throw error(fmt::format("the file ends within element {}, which declares {} rows",
                              element.name, element.count));
    }
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
  warn_of_unread(body.unread(), loaded.warnings);
  loaded.cloud.foreign_elements = std::move(foreign);
  loaded.cloud.comments = header.comments;
  return loaded;
}

}  // namespace

LoadedCloud read_ply(const InputFile& file) {
  const PlyHeader header = read_ply_header(file);
  check_has_vertices(file, header);
  if (header.encoding != PlyEncoding::kAscii) {
    return read_elements(file, header, PlyBinaryBody(file, header), false);
  }
  return keep_spelled_digits(read_elements(file, header, AsciiBody(file, header), false), [&] {
    return read_elements(file, header, AsciiBody(file, header), true);
  });
}

}  // namespace pcednet::io
