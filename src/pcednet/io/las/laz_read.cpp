#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_coder.h"

namespace pcednet::io {
namespace {

constexpr unsigned kUnchunked = 1, kChunked = 2, kLayered = 3;
constexpr std::uint64_t kVariable = laz_record::kVariableSize;
constexpr std::uint64_t kSymbolsPerByte = 1024;

/// Whether that many bytes of a chunk can encode that many symbols, which take `memory` bytes: the
/// adaptive models reach at most 1024 a byte, 115 if all 50,000 of a chunk are equal, and where
/// they would take much memory only 128 are accepted.
bool may_stand_for(std::uint64_t bytes, std::uint64_t symbols, std::uint64_t memory) {
  constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 26;
  return symbols / (memory > kMuchMemory ? 128 : kSymbolsPerByte) <= bytes;
}

}  // namespace

void LazReader::fail(std::uint64_t byte, const std::string& what) const {
  throw unreadable(file_.path(), fmt::format("byte {}: {}", byte, what));
}

LazReader::LazReader(const InputFile& file, LasFile& las, std::vector<std::string>& warnings)
    : file_(file), begin_(las.points_offset()), record_length_(las.record_length()) {
  const LasRecord* const record = find_record(las.records, kLaszipRecord);
  if (!record) fail(las_header::kPointFormat, "compressed, but without a laszip record");
  read_items(record->data);
  const std::uint64_t points = las.point_count();
  const bool holds_all = compressor_ == kUnchunked
                             ? may_stand_for(file_.size() - begin_, points, points * record_length_)
                             : points / kSymbolsPerByte <= file_.size();
  if (!holds_all) {
    fail(las.counts_wide() ? las_header::kPointCount64 : las_header::kPointCount32,
         fmt::format("{} points in a file of {} bytes", points, file_.size()));
  }
  if (points == 0) {
    recover(las, warnings);
  } else if (compressor_ == kUnchunked) {
    chunks_ = {{0, points, begin_, file_.size() - begin_}};
  } else {
    find_chunks(points, warnings);
  }
}

void LazReader::read_items(const std::string& record) {
  const auto refuse = [&](const std::string& what) {
    throw unreadable(file_.path(), "record laszip encoded: " + what);
  };
  compressor_ = number_at<std::uint16_t>(record, laz_record::kCompressor);
  if (compressor_ < kUnchunked || compressor_ > kLayered) {
    refuse(fmt::format("compressor {}; 1 to 3 are read", compressor_));
  }
  if (number_at<std::uint16_t>(record, laz_record::kCoder) != 0) {
    refuse("a coder that is not arithmetic");
  }
  chunk_size_ = number_at<std::uint32_t>(record, laz_record::kChunkSize);
  if (chunk_size_ == 0) chunk_size_ = kVariable;  // as LAStools writes into COPC
  const std::size_t count = number_at<std::uint16_t>(record, laz_record::kItemCount);
  if (record.size() < laz_record::kItems + laz_record::kItemBytes * count) refuse("ends early");
  std::size_t offset = 0;
  static constexpr std::size_t kSizes[] = {0, 0, 0, 0, 0, 0, 20, 8, 6, 29, 30, 6, 8, 29, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = laz_record::kItems + laz_record::kItemBytes * i;
    LazItem item{number_at<std::uint16_t>(record, at + laz_record::kItemType),
                 number_at<std::uint16_t>(record, at + laz_record::kItemSize),
                 number_at<std::uint16_t>(record, at + laz_record::kItemVersion), offset};
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

/// The offset of the chunk table, which may be stored at the end of the file; none if there is
/// none.
std::optional<std::uint64_t> LazReader::table_place() const {
  if (file_.size() < 8) return std::nullopt;
  auto place = number_at<std::uint64_t>(file_.text(begin_, 8), 0);
  if (place == UINT64_MAX) place = number_at<std::uint64_t>(file_.text(file_.size() - 8), 0);
  if (place < begin_ + 8 || place > file_.size() - 8) return std::nullopt;
  return place;
}

std::vector<LazReader::Entry> LazReader::read_table(std::uint64_t place) const {
  const std::size_t count =
      number_at<std::uint32_t>(file_.text(place, laz_table::kChunks), laz_table::kChunkCount);
  if (count > (place - begin_) / record_length_) fail(place, fmt::format("{} chunks", count));
  const std::string bytes = file_.text(place + laz_table::kChunks, 16 * std::uint64_t{count} + 64);
  laz::Decoder decoder;
  decoder.start(std::as_bytes(std::span(bytes)));
  laz::IntegerModel numbers(32, 2);
  std::int32_t points = 0, size = 0;
  std::vector<Entry> table(count);
  for (Entry& entry : table) {
    entry.points = chunk_size_;
    if (chunk_size_ == kVariable) {
      points = numbers.code(decoder, points, 0);
      entry.points = static_cast<std::uint32_t>(points);
    }
    size = numbers.code(decoder, size, 1);
    entry.bytes = static_cast<std::uint32_t>(size);
  }
  return table;
}

bool LazReader::may_hold(const Entry& chunk) const {
  // Each extra byte of each point has a symbol of its own in version 2.
  const LazItem& last = items_.back();
  const std::size_t extra = last.type == 0 && last.version == 2 ? last.size : 1;
  return chunk.points == 0 ||
         (chunk.bytes >= record_length_ &&
          may_stand_for(chunk.bytes, chunk.points * extra, chunk.points * record_length_));
}

/// Points of the chunk at byte `at` beyond the first `counted`, as far as known without decoding:
/// in pointwise coding, the last of equal chunks does not state its number.
std::uint64_t LazReader::points_behind(std::uint64_t counted, const Entry& chunk,
                                       std::uint64_t at) const {
  std::uint64_t held = chunk.points;
  if (chunk_size_ != kVariable && compressor_ == kLayered) {
    held = number_at<std::uint32_t>(file_.text(at + record_length_, 4), 0);
  } else if (chunk_size_ != kVariable && counted > 0) {
    held = counted;
  }
  return held - std::min(held, counted);
}

/// The chunks of the table, as far as `points` are counted.
void LazReader::find_chunks(std::uint64_t points, std::vector<std::string>& warnings) {
  const auto place = table_place();
  if (!place) {
    const auto said = number_at<std::int64_t>(file_.text(begin_, 8), 0);
    fail(begin_, fmt::format("the chunk table is at byte {}, where none can be: the file is cut "
                             "off, or its writing was interrupted",
                             said));
  }
  std::uint64_t at = begin_ + 8, first = 0, left_out = 0;
  const std::vector<Entry> table = read_table(*place);
  for (std::size_t c = 0; c < table.size(); ++c) {
    const std::uint64_t here = std::min(table[c].points, points - first);
    if (table[c].bytes > *place - at || !may_hold({here, table[c].bytes})) {
      fail(*place, fmt::format("chunk {} of {} points has {} bytes", c, here, table[c].bytes));
    }
    if (here > 0) chunks_.push_back({first, here, at, table[c].bytes});
    if (here < table[c].points) left_out += points_behind(here, table[c], at);
    at += table[c].bytes;
    first += here;
  }
  if (first < points) fail(*place, fmt::format("chunks for {} of {} points", first, points));
  if (left_out == 0) return;
  const bool known = chunk_size_ == kVariable || compressor_ == kLayered;
  warnings.push_back(
      fmt::format("the header counts {} points and the chunks {} {} more: these are left out",
                  points, known ? "hold" : "have room for", left_out));
}

/// Layered chunks from the beginning of the points on, each of which states its own size.
std::vector<LazReader::Entry> LazReader::walk_layered(std::uint64_t end) const {
  std::vector<Entry> found;
  const std::size_t head = record_length_ + 4 + 4 * laz::layer_count(items_);
  for (std::uint64_t at = begin_ + 8; at + head <= end;) {
    const std::string numbers = file_.text(at + record_length_, head - record_length_);
    Entry entry = {number_at<std::uint32_t>(numbers, 0), head};
    for (std::size_t l = 4; l < numbers.size(); l += 4) {
      entry.bytes += number_at<std::uint32_t>(numbers, l);
    }
    const bool sound = entry.points > 0 && entry.points <= chunk_size_ && may_hold(entry);
    if (!sound || entry.bytes > end - at) break;
    found.push_back(entry);
    at += entry.bytes;
  }
  return found;
}

void LazReader::recover(LasFile& las, std::vector<std::string>& warnings) {
  const auto place = table_place();
  const std::uint64_t end = place.value_or(las_points_limit(file_, las));
  std::vector<Entry> found;
  bool last_uncounted = false;
  if (compressor_ == kLayered) {
    found = walk_layered(end);
  } else if (compressor_ == kChunked && place) {
    found = read_table(*place);
    last_uncounted = chunk_size_ != kVariable && !found.empty();
    if (last_uncounted) found.pop_back();
  }
  const std::size_t count_byte =
      las.counts_wide() ? las_header::kPointCount64 : las_header::kPointCount32;
  if (found.empty() && !place && end > begin_ + 8 + record_length_) {
    fail(count_byte, fmt::format("no points, though {} bytes of compressed ones follow: the "
                                 "writing of the file was interrupted, and no whole chunk is found",
                                 end - begin_));
  }
  std::uint64_t at = begin_ + 8, first = 0;
  for (const Entry& entry : found) {
    if (entry.bytes > file_.size() - at || !may_hold(entry)) {
      fail(at, fmt::format("{} points in {} bytes", entry.points, entry.bytes));
    }
    if (entry.points > 0) chunks_.push_back({first, entry.points, at, entry.bytes});
    at += entry.bytes;
    first += entry.points;
  }
  las.set_point_count(first);
  if (las.point_count() != first) fail(count_byte, fmt::format("chunks of {} points", first));
  if (first == 0 && !last_uncounted) return;
  warnings.push_back(fmt::format(
      "the header counts no points, as where writing was interrupted: the {} of {} whole chunks "
      "are read{}",
      first, chunks_.size(),
      last_uncounted ? "; the last chunk does not say how many it has, and is left out" : ""));
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
