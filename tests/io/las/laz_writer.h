#pragma once

#include "io/las/las_writer.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_coder.h"

namespace pcednet::io {

/// How a compressed file is to be laid out, where ours are always the same.
struct LazTestLayout {
  std::vector<std::size_t> chunks = {};  ///< points of each
  bool fixed_size = false;               ///< all chunks but the last have chunks[0] points
  bool unchunked = false;
  bool table_at_end = false;  ///< found by the last eight bytes of the file
  bool size_zero = false;     ///< says 0, not 2^32 - 1, where chunks are of any size
  unsigned version = 0;       ///< of the items; 0: 2 or 3
};

inline std::vector<LazItem> test_items(const LasTestFile& file, unsigned version) {
  const unsigned f = file.format;
  std::vector<LazItem> items;
  const auto add = [&](unsigned type, std::size_t size, unsigned usual) {
    const std::size_t offset = items.empty() ? 0 : items.back().offset + items.back().size;
    items.push_back({type, size, version > 0 ? version : usual, offset});
  };
  if (f < 6) {
    add(6, 20, 2);
    if (f == 1 || f == 3) add(7, 8, 2);
    if (f == 2 || f == 3) add(8, 6, 2);
    if (file.extra > 0) add(0, file.extra, 2);
  } else {
    add(10, 30, 3);
    if (f == 7) add(11, 6, 3);
    if (f == 8) add(12, 8, 3);
    if (file.extra > 0) add(14, file.extra, 3);
  }
  return items;
}

inline LasTestRecord laz_test_record(const std::vector<LazItem>& items,
                                     const LazTestLayout& layout) {
  const bool layered = items[0].type == 10;
  const std::uint32_t any = layout.size_zero ? 0 : UINT32_MAX;
  const std::uint32_t size = layout.fixed_size ? static_cast<std::uint32_t>(layout.chunks[0]) : any;
  std::string data =
      packed(static_cast<std::uint16_t>(layout.unchunked ? 1
                                        : layered        ? 3
                                                         : 2),
             std::uint16_t{0}, std::uint8_t{3}, std::uint8_t{4}, std::uint16_t{0}, 0U, size,
             std::int64_t{-1}, std::int64_t{-1}, static_cast<std::uint16_t>(items.size()));
  for (const LazItem& item : items) {
    data += packed(static_cast<std::uint16_t>(item.type), static_cast<std::uint16_t>(item.size),
                   static_cast<std::uint16_t>(item.version));
  }
  return {"laszip encoded", 22204, data};
}

inline std::string test_chunk_table(const LazTestLayout& layout,
                                    const std::vector<std::size_t>& bytes) {
  laz::Encoder encoder;
  laz::IntegerModel numbers(32, 2);
  std::int32_t last_points = 0, last_bytes = 0;
  for (std::size_t c = 0; c < bytes.size(); ++c) {
    if (!layout.fixed_size) {
      const auto points = static_cast<std::int32_t>(layout.chunks[c]);
      last_points = numbers.code(encoder, last_points, 0, points);
    }
    last_bytes = numbers.code(encoder, last_bytes, 1, static_cast<std::int32_t>(bytes[c]));
  }
  return packed(0U, static_cast<std::uint32_t>(bytes.size())) + encoder.finish();
}

/// A LAZ file with chunks as `layout` has them; header and table are the test's own.
inline std::string laz_bytes(LasTestFile file, const LazTestLayout& layout) {
  const auto items = test_items(file, layout.version);
  file.records.push_back(laz_test_record(items, layout));
  const std::size_t stride = las_test_stride(file.format, file.extra);
  std::string whole = las_bytes(file);
  whole.resize(get_number<std::uint32_t>(whole, 96));
  whole[104] = static_cast<char>(file.format | 128U);
  const std::size_t points_offset = whole.size();
  std::string body;
  std::vector<std::size_t> sizes;
  std::size_t first = 0;
  for (const std::size_t points : layout.chunks) {
    std::string rows = file.rows.substr(first * stride, points * stride), chunk;
    const auto encode = file.format < 6 ? laz::encode_pointwise : laz::encode_layered;
    if (points > 0) chunk = encode(items, std::as_writable_bytes(std::span(rows)), stride);
    body += chunk;
    sizes.push_back(chunk.size());
    first += points;
  }
  if (layout.unchunked) return whole + body;
  const auto table = static_cast<std::int64_t>(points_offset + 8 + body.size());
  whole += packed(layout.table_at_end ? std::int64_t{-1} : table) + body;
  whole += test_chunk_table(layout, sizes);
  return layout.table_at_end ? whole + packed(table) : whole;
}

/// With another number at a place.
template <typename T>
std::string with(std::string bytes, std::size_t at, T value) {
  set_number(bytes, at, value);
  return bytes;
}

}  // namespace pcednet::io
