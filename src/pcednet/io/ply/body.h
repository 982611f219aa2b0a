#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/ply/header.h"

namespace pcednet::io {

bool is_vertex(const PlyElement& element);

/// The properties of the element vertex, without its lists.
std::vector<Column> scalar_columns(const PlyElement& vertex);

/// Throws Error(kInsufficient) if no element is called vertex.
void check_has_vertices(const InputFile& file, const PlyHeader& header);

/// Throws Error(kUnreadable) if the file is too short for `element`, which begins at `offset`.
void check_fits(const InputFile& file, const PlyElement& element, std::uint64_t offset, bool ascii);

/// Warns that `bytes` after the last element were not read, unless that is 0.
void warn_of_unread(std::uint64_t bytes, std::vector<std::string>& warnings);

/// Reads the elements of a binary body one after the other.
class PlyBinaryBody {
 public:
  /// Both must outlive it.
  PlyBinaryBody(const InputFile& file, const PlyHeader& header);

  std::uint64_t offset() const { return offset_; }
  std::uint64_t unread() const { return file_.size() - offset_; }

  void read_vertices(const PlyElement& vertex, const std::vector<Column>& columns,
                     CloudBuilder& builder);
  std::vector<std::byte> read_foreign(const PlyElement& element);

  /// Skips an element without lists.
  void skip(const PlyElement& element) { offset_ += element.count * element.fixed_bytes(); }

  /// Reads the vertices from `first` on, as many as `builder` has room for, of an element without
  /// lists that begins at `offset`.
  void read_rows(const PlyElement& vertex, std::uint64_t offset, std::uint64_t first,
                 CloudBuilder& builder) const;

 private:
  template <typename Visit>
  std::byte* walk(const PlyElement& element, std::uint64_t count, std::byte* begin,
                  const std::byte* end, Visit&& visit) const;
  Error broken_row(const PlyElement& element, std::uint64_t row, std::ptrdiff_t bytes) const;
  void read_list_vertices(const PlyElement& vertex, CloudBuilder& builder);
  std::span<std::byte> tail();

  const InputFile& file_;
  std::uint64_t offset_;
  bool swap_;
  std::vector<std::byte> tail_ = {};
  std::uint64_t tail_offset_ = 0;
};

}  // namespace pcednet::io
