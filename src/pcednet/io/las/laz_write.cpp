#include <algorithm>

#include "pcednet/core/parallel.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_coder.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kChunk = 50000;

std::vector<LazItem> items_of(const LasFile& file) {
  const unsigned format = file.point_format();
  std::vector<LazItem> items;
  const auto add = [&](unsigned type, std::size_t size, unsigned version) {
    const std::size_t offset = items.empty() ? 0 : items.back().offset + items.back().size;
    items.push_back({type, size, version, offset});
  };
  if (format < 6) {
    add(6, 20, 2);
    if (format != 0 && format != 2) add(7, 8, 2);
    if (format == 2 || format == 3 || format == 5) add(8, 6, 2);
    if (format > 3) add(9, 29, 1);
  } else {
    add(10, 30, 3);
    if (format == 7) add(11, 6, 3);
    if (format == 8 || format == 10) add(12, 8, 3);
    if (format > 8) add(13, 29, 3);
  }
  const std::size_t extra = file.record_length() - las_format_bytes(format);
  if (extra > 0) add(format < 6 ? 0 : 14, extra, format < 6 ? 2 : 3);
  return items;
}

}  // namespace

void add_laz_record(LasFile& file, LazChunks chunks) {
  const auto items = items_of(file);
  std::string data(laz_record::kItems + laz_record::kItemBytes * items.size(), '\0');
  put_number<std::uint16_t>(data, laz_record::kCompressor, file.point_format() < 6 ? 2 : 3);
  // The version of LASzip whose format this is.
  put_number<std::uint8_t>(data, laz_record::kMajorVersion, 3);
  put_number<std::uint8_t>(data, laz_record::kMinorVersion, 4);
  put_number<std::uint32_t>(data, laz_record::kChunkSize,
                            chunks == LazChunks::kVariable ? laz_record::kVariableSize : kChunk);
  put_number<std::int64_t>(data, laz_record::kSpecialCount, -1);
  put_number<std::int64_t>(data, laz_record::kSpecialOffset, -1);
  put_number(data, laz_record::kItemCount, static_cast<std::uint16_t>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::size_t at = laz_record::kItems + laz_record::kItemBytes * i;
    put_number(data, at + laz_record::kItemType, static_cast<std::uint16_t>(items[i].type));
    put_number(data, at + laz_record::kItemSize, static_cast<std::uint16_t>(items[i].size));
    put_number(data, at + laz_record::kItemVersion, static_cast<std::uint16_t>(items[i].version));
  }
  file.records.push_back(new_record(kLaszipRecord, "", std::move(data)));
}

LazPointWriter::LazPointWriter(OutputFile& out, const LasFile& file, std::uint64_t offset,
                               LazChunks chunks)
    : out_(out),
      items_(items_of(file)),
      layered_(file.point_format() >= 6),
      variable_(chunks == LazChunks::kVariable),
      stride_(file.record_length()),
      offset_(offset) {
  const std::string table_place(8, '\0');
  out_.write(table_place);
  bytes_ = table_place.size();
}

std::string LazPointWriter::compress(std::span<std::byte> rows) const {
  const auto encode = layered_ ? laz::encode_layered : laz::encode_pointwise;
  return encode(items_, rows, stride_);
}

void LazPointWriter::write_chunk(const std::string& chunk, std::size_t points) {
  out_.write(chunk);
  bytes_ += chunk.size();
  sizes_.push_back(chunk.size());
  points_.push_back(points);
}

std::vector<std::size_t> LazPointWriter::write_chunks(
    const std::vector<std::span<std::byte>>& rows) {
  std::vector<std::string> chunks(rows.size());
  parallel_blocks(rows.size(), 1,
                  [&](std::size_t c, std::size_t) { chunks[c] = compress(rows[c]); });
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    write_chunk(chunks[c], rows[c].size() / stride_);
  }
  return {sizes_.end() - static_cast<std::ptrdiff_t>(rows.size()), sizes_.end()};
}

void LazPointWriter::append(std::size_t count, const EncodePoints& encode) {
  constexpr std::size_t kChunksAtOnce = 8;
  const std::size_t before = waiting_.size() / stride_;
  const std::size_t full = (before + count) / kChunk;
  // Where, among the points to append, a chunk begins; the first began with those that wait.
  const auto begin_of = [&](std::size_t chunk) { return chunk == 0 ? 0 : chunk * kChunk - before; };
  for (std::size_t start = 0; start < full; start += kChunksAtOnce) {
    std::vector<std::string> chunks(std::min(full - start, kChunksAtOnce));
    parallel_blocks(chunks.size(), 1, [&](std::size_t c, std::size_t) {
      const std::size_t chunk = start + c;
      std::string rows = chunk == 0 ? waiting_ : "";
      encode(begin_of(chunk), begin_of(chunk + 1), rows);
      chunks[c] = compress(std::as_writable_bytes(std::span(rows)));
    });
    for (const std::string& chunk : chunks) write_chunk(chunk, kChunk);
  }
  if (full > 0) waiting_.clear();
  encode(begin_of(full), count, waiting_);
}

std::string LazPointWriter::chunk_table() const {
  std::string table(laz_table::kChunks, '\0');
  put_number(table, laz_table::kChunkCount, static_cast<std::uint32_t>(sizes_.size()));
  laz::Encoder encoder;
  laz::IntegerModel numbers(32, 2);
  std::int32_t points = 0, size = 0;
  for (std::size_t c = 0; c < sizes_.size(); ++c) {
    if (variable_) {
      points = numbers.code(encoder, points, 0, static_cast<std::int32_t>(points_[c]));
    }
    size = numbers.code(encoder, size, 1, static_cast<std::int32_t>(sizes_[c]));
  }
  return table + encoder.finish();
}

std::uint64_t LazPointWriter::finish() {
  if (!waiting_.empty()) {
    const std::size_t points = waiting_.size() / stride_;
    write_chunk(compress(std::as_writable_bytes(std::span(waiting_))), points);
  }
  std::string table_place(8, '\0');
  put_number(table_place, 0, static_cast<std::int64_t>(place()));
  out_.write_at(offset_, std::as_bytes(std::span(table_place)));
  const std::string table = chunk_table();
  out_.write(table);
  return bytes_ + table.size();
}

}  // namespace pcednet::io
