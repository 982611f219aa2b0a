#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/write_options.h"

namespace pcednet::formats {

/// A format of point files. A function that it lacks is null.
struct Format {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< in lower case, with the dot

  bool is_mesh = false;  ///< of triangles alone, whose corners are the points

  /// Whether a file with this beginning is of this format, with any extension.
  bool (*begins)(std::string_view start) = nullptr;
  /// The number of points by the header.
  std::uint64_t (*points)(const io::InputFile& file) = nullptr;
  io::LoadedCloud (*read)(const io::InputFile& file) = nullptr;
  std::unique_ptr<io::PartReader> (*open_parts)(std::unique_ptr<io::InputFile> file,
                                                std::size_t most) = nullptr;

  /// Null for a format that is written in parts.
  void (*write)(const std::filesystem::path& path, const PointCloud& cloud,
                const io::WriteOptions& options) = nullptr;
  std::unique_ptr<io::PartWriter> (*create_parts)(const std::filesystem::path& path,
                                                  const io::PartOutline& outline,
                                                  const io::WriteOptions& options) = nullptr;
  /// Throws if it cannot hold the positions; null if it holds all.
  void (*check_positions)(const std::filesystem::path& path, const PointCloud& cloud) = nullptr;
  /// The data of a cloud, foreign elements aside, that it cannot hold; null if it holds everything.
  std::vector<std::string> (*losses)(const std::filesystem::path& path,
                                     const PointCloud& cloud) = nullptr;
  /// Whether it holds that element; null if it holds none.
  bool (*keeps)(const ForeignElement& element) = nullptr;

  bool is_written() const { return write != nullptr || create_parts != nullptr; }
  bool is_las() const { return name == "LAS"; }
  bool is_text() const { return name == "text"; }
  /// Whether tiles are read from it, and written to it: not text, whose parts must be found by
  /// reading it.
  bool is_tiled() const { return !is_text() && open_parts && create_parts; }
};

/// All formats. Where the beginning of a file fits several, the first counts.
std::span<const Format> all_formats();

/// The format to read a file as: by its beginning, otherwise by its extension. Throws
/// Error(kUnreadable) if there is none, or the file has no bytes.
const Format& format_of(const io::InputFile& file);

/// The format to write under that name. Throws Error(kUsage) if there is none.
const Format& format_for(const std::filesystem::path& path);

/// The format of that extension, in small letters or capitals; null if there is none.
const Format* find_format(const std::filesystem::path& path);

/// The name of a file without its folder and extension; .copc.laz counts as one extension.
std::string stem_of(const std::filesystem::path& path);

/// Adds the elements other than points that the format drops, as phrases.
void add_lost_elements(const PointCloud& cloud, const Format& format,
                       std::vector<std::string>& lost);

/// The extensions of formats that can be read, or written, such as ".ply .pcd .las"; `last`
/// separates the last one.
std::string extensions_read(std::string_view last = " ");
std::string extensions_written(std::string_view last = " ");

}  // namespace pcednet::formats
