#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pcednet/core/output_file.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/las_file.h"

namespace pcednet::io {

/// A part of a point record as LASzip compresses it.
struct LazItem {
  unsigned type = 0;
  std::size_t size = 0;
  unsigned version = 0;
  std::size_t offset = 0;  ///< bytes into the record
};

/// The compressed points of a LAZ file, chunk by chunk, after the specification of LASzip:
/// unchunked, chunked and layered; chunks of fixed and of variable size.
class LazReader {
 public:
  /// Reads the chunk table. Throws Error(kUnreadable), naming the byte, for what is not LASzip or
  /// does not fit the file. `file` must outlive the reader.
  LazReader(const InputFile& file, const LasFile& las);

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
  void read_items(const std::string& record);
  void read_chunk_table(const LasFile& las);
  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const;

  const InputFile& file_;
  std::vector<LazItem> items_;
  std::vector<Chunk> chunks_;
  unsigned compressor_ = 0;
  std::uint64_t chunk_size_ = 0;
  std::size_t record_length_ = 0;
};

/// Adds the record that says how the points will be compressed.
void add_laz_record(LasFile& file);

/// Writes the compressed points with their chunk table.
class LazPointWriter {
 public:
  /// The points begin at `offset` of the file, where `out` must stand; `out` must outlive it.
  LazPointWriter(OutputFile& out, const LasFile& file, std::uint64_t offset);

  /// Takes `count` more points; `encode` appends the records of a range of them.
  void append(std::size_t count,
              const std::function<void(std::size_t, std::size_t, std::string&)>& encode);

  /// Returns the bytes that points and table take.
  std::uint64_t finish();

 private:
  void write_chunk(const std::string& chunk);
  std::string compress(std::string& rows) const;

  OutputFile& out_;
  std::vector<LazItem> items_;
  bool layered_;
  std::size_t stride_;
  std::uint64_t offset_, bytes_ = 0;
  std::string waiting_ = {};  ///< records of a chunk that is not full
  std::vector<std::size_t> sizes_ = {};
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

}  // namespace laz
}  // namespace pcednet::io
