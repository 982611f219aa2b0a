#include <fmt/format.h>

#include <algorithm>

#include "pcednet/io/laz.h"
#include "pcednet/io/laz_coder.h"

namespace pcednet::io {
namespace {

constexpr unsigned kUnchunked = 1, kChunked = 2, kLayered = 3;
constexpr std::uint64_t kVariable = UINT32_MAX;
constexpr std::uint64_t kSymbolsPerByte = 1024;

/// Whether so many bytes of a chunk may stand for so many symbols: the adaptive models do not get
/// cheaper than 1024 a byte, and where they would take much memory 64 are believed.
bool may_hold(std::uint64_t bytes, std::uint64_t symbols) {
  constexpr std::uint64_t kMany = std::uint64_t{1} << 20;
  return symbols / (symbols > kMany ? 64 : kSymbolsPerByte) <= bytes;
}

}  // namespace

void LazReader::fail(std::uint64_t byte, const std::string& what) const {
  throw unreadable(file_.path(), fmt::format("byte {}: {}", byte, what));
}

LazReader::LazReader(const InputFile& file, const LasFile& las)
    : file_(file), record_length_(las.record_length()) {
  const auto found = std::find_if(las.records.begin(), las.records.end(),
                                  [](const LasRecord& r) { return r.is("laszip encoded", 22204); });
  if (found == las.records.end()) fail(104, "compressed, but no record says how");
  read_items(found->data);
  if (las.point_count() > 0) read_chunk_table(las);
}

void LazReader::read_items(const std::string& record) {
  const auto refuse = [&](const std::string& what) {
    throw unreadable(file_.path(), "record laszip encoded: " + what);
  };
  compressor_ = number_at<std::uint16_t>(record, 0);
  if (compressor_ < kUnchunked || compressor_ > kLayered) {
    refuse(fmt::format("compressor {}; 1 to 3 are read", compressor_));
  }
  if (number_at<std::uint16_t>(record, 2) != 0) refuse("a coder that is not arithmetic");
  chunk_size_ = number_at<std::uint32_t>(record, 12);
  const std::size_t count = number_at<std::uint16_t>(record, 32);
  if (record.size() < 34 + 6 * count) refuse("ends early");
  std::size_t offset = 0;
  static constexpr std::size_t kSizes[] = {0, 0, 0, 0, 0, 0, 20, 8, 6, 29, 30, 6, 8, 29, 0};
  for (std::size_t i = 0; i < count; ++i) {
    LazItem item{number_at<std::uint16_t>(record, 34 + 6 * i),
                 number_at<std::uint16_t>(record, 36 + 6 * i),
                 number_at<std::uint16_t>(record, 38 + 6 * i), offset};
    const bool layered = compressor_ == kLayered;
    const bool known = item.type == 0 || (item.type >= 6 && item.type <= 14);
    const bool sound = known && (item.type >= 10) == layered && item.size > 0 &&
                       (kSizes[item.type] == 0 || kSizes[item.type] == item.size) &&
                       (layered ? item.version >= 2 && item.version <= 4
                                : item.version == 1 || item.version == 2) &&
                       (i > 0 || item.type == (layered ? 10U : 6U));
    if (!sound) {
      refuse(fmt::format("item {} of type {}, {} bytes, version {}", i, item.type, item.size,
                         item.version));
    }
    offset += item.size;
    items_.push_back(item);
  }
  if (offset != record_length_) {
    refuse(fmt::format("items of {} bytes for points of {}", offset, record_length_));
  }
}

void LazReader::read_chunk_table(const LasFile& las) {
  const std::uint64_t begin = las.points_offset(), points = las.point_count();
  const bool holds_all = compressor_ == kUnchunked ? may_hold(file_.size() - begin, points)
                                                   : points / kSymbolsPerByte <= file_.size();
  if (!holds_all) {
    fail(las.counts_wide() ? 247 : 107,
         fmt::format("{} points in a file of {} bytes", points, file_.size()));
  }
  if (compressor_ == kUnchunked) {
    chunks_ = {{0, points, begin, file_.size() - begin}};
    return;
  }
  auto table = number_at<std::int64_t>(file_.text(begin, 8), 0);
  if (table == -1 && file_.size() >= 8) {
    table = number_at<std::int64_t>(file_.text(file_.size() - 8), 0);
  }
  const auto place = static_cast<std::uint64_t>(table);
  if (place < begin + 8 || file_.size() < 8 || place > file_.size() - 8) {
    fail(begin, fmt::format("the chunk table is at byte {}", table));
  }
  const std::size_t count = number_at<std::uint32_t>(file_.text(place, 8), 4);
  if (count > (place - begin) / record_length_) fail(place, fmt::format("{} chunks", count));
  const std::string bytes = file_.text(place + 8, 16 * std::uint64_t{count} + 64);
  laz::Decoder decoder;
  decoder.start(std::as_bytes(std::span(bytes)));
  laz::IntegerModel numbers(32, 2);
  std::uint64_t at = begin + 8, first = 0;
  std::int32_t last_points = 0, last_bytes = 0;
  // Each extra byte of each point has a symbol of its own in version 2.
  const LazItem& last = items_.back();
  const std::size_t extra = last.type == 0 && last.version == 2 ? last.size : 0;
  for (std::size_t c = 0; c < count; ++c) {
    std::uint64_t here = chunk_size_;
    if (chunk_size_ == kVariable) {
      last_points = numbers.code(decoder, last_points, 0);
      here = static_cast<std::uint32_t>(last_points);
    }
    last_bytes = numbers.code(decoder, last_bytes, 1);
    const auto size = static_cast<std::uint32_t>(last_bytes);
    here = std::min(here, points - first);
    const std::uint64_t symbols = here * std::max<std::uint64_t>(1, extra);
    const bool holds = here == 0 || (size >= record_length_ && may_hold(size, symbols));
    if (size > place - at || !holds) {
      fail(place, fmt::format("chunk {} of {} points has {} bytes", c, here, size));
    }
    if (here > 0) chunks_.push_back({first, here, at, size});
    at += size;
    first += here;
  }
  if (first < points) fail(place, fmt::format("chunks for {} of {} points", first, points));
}

std::vector<std::byte> LazReader::decode(std::size_t chunk) const {
  const Chunk& place = chunks_[chunk];
  std::vector<std::byte> bytes(place.bytes), rows(place.points * record_length_);
  file_.read(place.begin, bytes);
  const auto decode = compressor_ == kLayered ? laz::decode_layered : laz::decode_pointwise;
  if (!decode(items_, bytes, rows, record_length_)) {
    fail(place.begin, fmt::format("chunk {} of {} points ends early", chunk, place.points));
  }
  return rows;
}

}  // namespace pcednet::io
