#include "pcednet/io/ply/body.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "pcednet/core/parallel.h"
#include "pcednet/io/ply/rows.h"
#include "pcednet/io/row_feeder.h"

namespace pcednet::io {
namespace {

void ignore(std::size_t, const std::byte*, ScalarType, bool) {}

/// The least bytes of a row: its lists may be empty.
std::size_t least_row_bytes(const PlyElement& element, bool ascii) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += ascii ? 2 : size_of(property.length_type.value_or(property.type));
  }
  return bytes;
}

}  // namespace

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

void check_has_vertices(const InputFile& file, const PlyHeader& header) {
  if (std::any_of(header.elements.begin(), header.elements.end(), is_vertex)) return;
  std::string names;
  for (const PlyElement& element : header.elements) names += " " + element.name;
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: points are read from an element vertex; there is{}",
                          file.path().string(), names.empty() ? " no element" : names));
}

void check_fits(const InputFile& file, const PlyElement& element, std::uint64_t offset,
                bool ascii) {
  const std::size_t row = least_row_bytes(element, ascii);
  // The last line may lack its end.
  const std::uint64_t left = file.size() - offset + (ascii ? 1 : 0);
  if (row != 0 && element.count > left / row) {
    throw unreadable(file.path(),
                     fmt::format("declares {} rows of element {}, of {} bytes or more each, but "
                                 "ends {} bytes after byte {}",
                                 element.count, element.name, row, file.size() - offset, offset));
  }
}

void warn_of_unread(std::uint64_t bytes, std::vector<std::string>& warnings) {
  if (bytes == 0) return;
  warnings.push_back(fmt::format("{} bytes after the last element were not read", bytes));
}

PlyBinaryBody::PlyBinaryBody(const InputFile& file, const PlyHeader& header)
    : file_(file), offset_(header.bytes), swap_(header.encoding == PlyEncoding::kBigEndian) {}

void PlyBinaryBody::read_vertices(const PlyElement& vertex, const std::vector<Column>&,
                                  CloudBuilder& builder) {
  if (vertex.has_lists()) return read_list_vertices(vertex, builder);
  read_rows(vertex, offset_, 0, builder);
  skip(vertex);
}

void PlyBinaryBody::read_rows(const PlyElement& vertex, std::uint64_t offset, std::uint64_t first,
                              CloudBuilder& builder) const {
  const std::size_t row = vertex.fixed_bytes();
  const std::size_t block = std::max<std::size_t>(1, (std::size_t{1} << 19) / row);
  parallel_blocks(builder.size(), block, [&](std::size_t begin, std::size_t end) {
    const std::size_t bytes = (end - begin) * row;
    const auto rows = std::make_unique_for_overwrite<std::byte[]>(bytes);
    file_.read(offset + (first + begin) * row, {rows.get(), bytes});
    if (swap_) walk(vertex, end - begin, rows.get(), rows.get() + bytes, ignore);
    builder.fill_rows(rows.get(), begin, end);
  });
}

std::vector<std::byte> PlyBinaryBody::read_foreign(const PlyElement& element) {
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

/// Walks `count` rows; throws if they do not end before `end`.
template <typename Visit>
std::byte* PlyBinaryBody::walk(const PlyElement& element, std::uint64_t count, std::byte* begin,
                               const std::byte* end, Visit&& visit) const {
  std::byte* row = begin;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::byte* const next = walk_ply_row(element, row, end, swap_, visit);
    if (!next) throw broken_row(element, i, row - begin);
    row = next;
  }
  return row;
}

/// The row number `row` of an element that begins at `offset_`, `bytes` behind that.
Error PlyBinaryBody::broken_row(const PlyElement& element, std::uint64_t row,
                                std::ptrdiff_t bytes) const {
  return unreadable(file_.path(),
                    fmt::format("byte {}: row {} of {} of element {} is broken or cut off",
                                offset_ + static_cast<std::uint64_t>(bytes), row + 1, element.count,
                                element.name));
}

void PlyBinaryBody::read_list_vertices(const PlyElement& vertex, CloudBuilder& builder) {
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
    std::byte* const next = walk_ply_row(vertex, row, end, swap_, keep);
    if (!next) throw broken_row(vertex, i, row - left.data());
    row = next;
  }
  feeder.flush();
  offset_ += static_cast<std::uint64_t>(row - left.data());
}

/// The file from `offset_` to its end, in memory.
std::span<std::byte> PlyBinaryBody::tail() {
  if (tail_.empty()) {
    tail_offset_ = offset_;
    tail_.resize(file_.size() - offset_);
    file_.read(offset_, tail_);
  }
  return std::span(tail_).subspan(offset_ - tail_offset_);
}

}  // namespace pcednet::io
