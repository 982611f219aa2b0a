#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/attribute.h"
#include "pcednet/io/input_file.h"

namespace pcednet::io {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;  ///< of the number, or of the numbers in the list
  std::optional<ScalarType> length_type;   ///< set for a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::string text;  ///< its lines of the header, each ended by \n

  bool has_lists() const;
  /// Bytes of a row, or of its part outside lists.
  std::size_t fixed_bytes() const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< "obj_info ..." lines keep that prefix
  std::size_t bytes = 0;              ///< where the data begins
  std::size_t lines = 0;
};

/// Reads the header at the start of `file`. Throws Error(kUnreadable) naming file and line.
PlyHeader read_ply_header(const InputFile& file);

/// The same from a text that holds the whole header; messages name `path`.
PlyHeader parse_ply_header(const std::filesystem::path& path, std::string_view text);

/// The name of a type that every reader knows: uchar, int, double, ...; PLY has no 64-bit integers.
std::string_view ply_type_name(ScalarType type);

}  // namespace pcednet::io
