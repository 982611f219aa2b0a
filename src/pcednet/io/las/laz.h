#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/output_file.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {

namespace laz {
/// The kinds of items, by their numbers in LASzip's record. Kinds above 9 are coded in layers.
enum ItemType : unsigned {
  kByte = 0,
  kPoint10 = 6,
  kGpsTime11 = 7,
  kRgb12 = 8,
  kWave13 = 9,
  kPoint14 = 10,
  kRgb14 = 11,
  kRgbNir14 = 12,
  kWave14 = 13,
  kByte14 = 14,
};
}  // namespace laz

/// A part of a point record as LASzip compresses it.
struct LazItem {
  unsigned type = 0;  ///< laz::ItemType
  std::size_t size = 0;
  unsigned version = 0;
  std::size_t offset = 0;  ///< bytes into the record
};

/// The compressed points of a LAZ file, chunk by chunk, by the specification of LASzip: unchunked,
/// chunked and layered; chunks of fixed and of variable size.
class LazReader {
 public:
  /// Finds the chunks. Where the header counts no points, as in a file whose writing was
  /// interrupted, the points of the existing chunks are used from here on, with a warning; chunks
  /// beyond the counted points are left out with a warning. Throws Error(kUnreadable), naming the
  /// byte, for data that is not LASzip or does not fit the file. `file` must outlive the reader.
  LazReader(const InputFile& file, LasFile& las, std::vector<std::string>& warnings);

  std::size_t chunk_count() const { return chunks_.size(); }
  /// The first point of a chunk.
  std::size_t chunk_begin(std::size_t chunk) const { return chunks_[chunk].first_point; }
  /// The records of a chunk; may be called from several threads. Throws Error(kUnreadable) for a
  /// chunk that ends early.
  std::vector<std::byte> decode(std::size_t chunk) const;

 private:
  struct Chunk {
    std::size_t first_point = 0, points = 0;
    std::uint64_t begin = 0, bytes = 0;
  };
  /// The chunk table's entry for a chunk.
  struct Entry {
    std::uint64_t points = 0, bytes = 0;
  };
  void read_items(const std::string& record);
  std::optional<std::uint64_t> table_place() const;
  std::vector<Entry> read_table(std::uint64_t place) const;
  std::uint64_t points_behind(std::uint64_t counted, const Entry& chunk, std::uint64_t at) const;
  void find_chunks(std::uint64_t points, std::vector<std::string>& warnings);
  void recover(LasFile& las, std::vector<std::string>& warnings);
  std::vector<Entry> walk_layered(std::uint64_t end) const;
  bool may_hold(const Entry& chunk) const;
  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const;

  const InputFile& file_;
  std::vector<LazItem> items_;
  std::vector<Chunk> chunks_;
  unsigned compressor_ = 0;
  std::uint64_t chunk_size_ = 0;  ///< points of each; kVariable: see the table
  std::uint64_t begin_ = 0;       ///< of the points
  std::size_t record_length_ = 0;
};

/// The number of points of a chunk: the same for all but the last, or individual, in the table.
enum class LazChunks { kEqual, kVariable };

/// Adds the record that describes the compression of the points.
void add_laz_record(LasFile& file, LazChunks chunks = LazChunks::kEqual);

/// Writes the compressed points with their chunk table.
class LazPointWriter {
 public:
  /// The points begin at `offset` of the file, the position of `out`, which must outlive it.
  LazPointWriter(OutputFile& out, const LasFile& file, std::uint64_t offset,
                 LazChunks chunks = LazChunks::kEqual);

  /// Takes `count` more points, for equal chunks.
  void append(std::size_t count, const EncodePoints& encode);

  /// Writes each of `rows` as a chunk of variable size, compressed on all threads. Returns the
  /// bytes of each.
  std::vector<std::size_t> write_chunks(const std::vector<std::span<std::byte>>& rows);

  /// Where the next chunk will begin.
  std::uint64_t place() const { return offset_ + bytes_; }

  /// Returns the bytes that points and table take.
  std::uint64_t finish();

 private:
  void write_chunk(const std::string& chunk, std::size_t points);
  std::string compress(std::span<std::byte> rows) const;
  std::string chunk_table() const;

  OutputFile& out_;
  std::vector<LazItem> items_;
  bool layered_, variable_;
  std::size_t stride_;
  std::uint64_t offset_, bytes_ = 0;
  std::string waiting_ = {};                           ///< records of a chunk that is not full
  std::vector<std::size_t> sizes_ = {}, points_ = {};  ///< of the chunks
};

namespace laz {

/// Compresses or decodes the records of one chunk, one after the other (types 0 to 9) or layer by
/// layer (10 to 14). Decoding returns false if the bytes end early.
std::string encode_pointwise(const std::vector<LazItem>& items, std::span<std::byte> rows,
                             std::size_t stride);
bool decode_pointwise(const std::vector<LazItem>& items, std::span<const std::byte> bytes,
                      std::span<std::byte> rows, std::size_t stride);
std::string encode_layered(const std::vector<LazItem>& items, std::span<std::byte> rows,
                           std::size_t stride);
bool decode_layered(const std::vector<LazItem>& items, std::span<const std::byte> bytes,
                    std::span<std::byte> rows, std::size_t stride);

/// The number of layers of a chunk of such items. The chunk begins with a record, the number of its
/// records and the sizes of the layers, all in 32 bits.
std::size_t layer_count(const std::vector<LazItem>& items);

}  // namespace laz
}  // namespace pcednet::io
