#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "pcednet/core/counted.h"
#include "pcednet/core/parallel.h"
#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/pcd/header.h"
#include "pcednet/io/pcd/lzf.h"
#include "pcednet/io/pcd/pcd.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/row_feeder.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// No byte of LZF expands to more bytes than this: three give at most 264.
constexpr std::uint64_t kMostLzfGain = 88;

/// Returns the bytes after the last point.
std::uint64_t read_ascii(const InputFile& file, const PcdHeader& header, CloudBuilder& builder) {
  const std::string text = file.text(header.bytes);
  Lines lines(text, header.lines);
  RowFeeder feeder(builder);
  std::vector<std::string_view> words;
  const std::size_t numbers = header.numbers_per_point();
  for (std::uint64_t i = 0; i < header.points; ++i) {
    std::string_view line;
    if (!lines.next_filled(line)) {
      throw unreadable(file.path(),
                       fmt::format("the file ends after {} of {} points", i, header.points),
                       lines.number());
    }
    split(line, words);
    if (words.size() != numbers) {
      throw unreadable(file.path(),
                       fmt::format("{} instead of {}", counted(words.size(), "number"), numbers),
                       lines.number());
    }
    std::byte* number = feeder.next_row();
    auto word = words.begin();
    for (const Column& field : header.fields) {
      for (std::size_t c = 0; c < field.count; ++c, ++word, number += size_of(field.type)) {
        if (parse_number(*word, field.type, number)) continue;
        throw unreadable(file.path(),
                         fmt::format("{}: not a number of its type: {:.40}", field.name, *word),
                         lines.number());
      }
    }
  }
  feeder.flush();
  return lines.unread();
}

void read_binary(const InputFile& file, const PcdHeader& header, CloudBuilder& builder) {
  const std::size_t row = header.row_bytes();
  const std::size_t block = std::max<std::size_t>(1, (std::size_t{1} << 19) / row);
  parallel_blocks(builder.size(), block, [&](std::size_t begin, std::size_t end) {
    const std::size_t bytes = (end - begin) * row;
    const auto rows = std::make_unique_for_overwrite<std::byte[]>(bytes);
    file.read(header.bytes + begin * row, {rows.get(), bytes});
    builder.fill_rows(rows.get(), begin, end);
  });
}

struct Unpacked {
  std::vector<std::byte> bytes = {};
  std::uint64_t unread = 0;  ///< bytes of the file after those packed
};

Unpacked read_compressed(const InputFile& file, const PcdHeader& header) {
  std::array<std::uint32_t, 2> sizes = {};  // compressed, plain
  file.read(header.bytes, std::as_writable_bytes(std::span(sizes)));
  const std::uint64_t begin = header.bytes + sizeof sizes;
  if (sizes[0] > file.size() - begin || sizes[1] > kMostLzfGain * sizes[0]) {
    throw unreadable(file.path(),
                     fmt::format("byte {}: declares {} bytes packed in {}, but holds {}",
                                 header.bytes, sizes[1], sizes[0], file.size() - begin));
  }
  const std::size_t row = header.row_bytes();
  if (sizes[1] % row != 0 || sizes[1] / row != header.points) {
    throw unreadable(file.path(), fmt::format("byte {}: {} bytes for {} points of {} bytes",
                                              header.bytes, sizes[1], header.points, row));
  }
  std::vector<std::byte> packed(sizes[0]), plain(sizes[1]);
  file.read(begin, packed);
  if (!unpack_lzf(packed, plain)) {
    throw unreadable(file.path(), fmt::format("byte {}: the packed data are damaged", begin));
  }
  return {std::move(plain), file.size() - begin - packed.size()};
}

/// Fills a builder from fields that lie one after the other, each for all points.
void fill_fields(const std::vector<std::byte>& plain, const PcdHeader& header,
                 CloudBuilder& builder) {
  const std::byte* field = plain.data();
  for (std::size_t f = 0; f < header.fields.size(); ++f) {
    const std::size_t stride = header.fields[f].count * size_of(header.fields[f].type);
    builder.fill(f, field, stride, 0, builder.size());
    field += stride * builder.size();
  }
}

void check_fits(const InputFile& file, const PcdHeader& header) {
  const bool ascii = header.encoding == PcdEncoding::kAscii;
  const std::uint64_t row = ascii ? 2 * header.numbers_per_point() : header.row_bytes();
  const std::uint64_t left = file.size() - header.bytes;
  // The last line may lack its end.
  if (header.points > (left + (ascii ? 1 : 0)) / row) {
    throw unreadable(
        file.path(),
        fmt::format("declares {} points, of {} bytes or more each, but ends {} bytes after byte {}",
                    header.points, row, left, header.bytes));
  }
}

void warn_of_unread_data(std::uint64_t bytes, const PcdHeader& header,
                         std::vector<std::string>& warnings) {
  if (bytes == 0) return;
  warnings.push_back(fmt::format("{} bytes after the {} points of the header were not read", bytes,
                                 header.points));
}

LoadedCloud read_body(const InputFile& file, const PcdHeader& header) {
  Unpacked unpacked;
  if (header.encoding != PcdEncoding::kCompressed) {
    check_fits(file, header);
  } else if (header.points > 0) {
    unpacked = read_compressed(file, header);
  }
  CloudBuilder builder(file.path(), header.fields, header.points);
  std::uint64_t unread = 0;
  switch (header.encoding) {
    case PcdEncoding::kAscii:
      unread = read_ascii(file, header, builder);
      break;
    case PcdEncoding::kBinary:
      read_binary(file, header, builder);
      unread = file.size() - header.bytes - header.points * header.row_bytes();
      break;
    case PcdEncoding::kCompressed:
      if (header.points > 0) fill_fields(unpacked.bytes, header, builder);
      unread = unpacked.unread;
      break;
  }
  LoadedCloud loaded = builder.finish();
  warn_of_unread_data(unread, header, loaded.warnings);
  loaded.cloud.comments = header.comments;
  return loaded;
}

}  // namespace

LoadedCloud read_pcd(const InputFile& file) {
  const PcdHeader header = read_pcd_header(file);
  LoadedCloud loaded = read_body(file, header);
  if (header.encoding != PcdEncoding::kAscii) return loaded;
  return keep_spelled_digits(std::move(loaded), [&] {
    PcdHeader wide = header;
    widen_positions(wide.fields);
    return read_body(file, wide);
  });
}

}  // namespace pcednet::io
