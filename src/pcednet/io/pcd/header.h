#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/input_file.h"

namespace pcednet::io {

enum class PcdEncoding { kAscii, kBinary, kCompressed };

struct PcdHeader {
  std::vector<Column> fields;
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::uint64_t points = 0;
  PcdEncoding encoding = PcdEncoding::kAscii;
  std::vector<std::string> comments;
  std::size_t bytes = 0;  ///< where the data begins
  std::size_t lines = 0;

  std::size_t row_bytes() const;
  std::size_t numbers_per_point() const;
};

/// Reads the header at the start of `file`. Throws Error(kUnreadable) naming file and line.
PcdHeader read_pcd_header(const InputFile& file);

}  // namespace pcednet::io
