#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "pcednet/io/parts.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// Points of a chunk, unless the file has its own chunks: LAZ is read in these.
inline constexpr std::size_t kChunkPoints = 50'000;

/// Opens an input, or a tile, to read it chunk by chunk: LAS, LAZ and binary PLY. Throws as
/// formats::open_parts() does, and Error(kUsage) for other formats.
std::unique_ptr<io::PartReader> open_chunks(const std::filesystem::path& path);

/// Throws Error(kUsage) if the output is one of the inputs.
void check_not_input(const std::filesystem::path& output, std::span<const PlannedInput> inputs);

/// Throws Error(kUnreadable) if an input of a plan is missing, or has another size.
void check_size(const PlannedInput& input);

/// Calls `use` with every chunk of a planned input that is wanted, finished and in order, and with
/// the number of its first point in the file; several are read at a time. Throws Error(kUnreadable)
/// if the file or a wanted chunk has changed since the plan.
void for_each_chunk(const PlannedInput& input, const std::function<bool(const Chunk&)>& is_wanted,
                    const Progress* progress,
                    const std::function<void(PointCloud&, std::size_t first)>& use);

/// Reads several parts at a time and uses them one by one, in order.
void read_in_turn(std::span<const std::size_t> parts,
                  const std::function<PointCloud(std::size_t)>& read,
                  const std::function<void(PointCloud&, std::size_t part)>& use);

struct IndexedInput {
  PlannedInput input;
  PointCloud outline;                ///< its columns and its content beside points, without points
  std::vector<std::string> columns;  ///< as texts, to compare
  bool has_times = false;            ///< a GPS time of LAS is not 0
};

/// Reads the whole file and lists its chunks; `see` gets each, finished. `narrow_colours`, if
/// given, is that of the whole of which the file is a part.
IndexedInput index_input(const std::filesystem::path& path, const Progress* progress,
                         std::vector<std::string>& notes,
                         const std::function<void(const PointCloud&)>& see,
                         std::optional<bool> narrow_colours = {});

/// The content of the tiles beside points, from the plan's forms, and their columns.
PointCloud outline_of(const Plan& plan);

/// Chunk `chunk` of a file that is not an input of the plan, finished.
PointCloud read_finished(const io::PartReader& reader, std::size_t chunk);

/// Appends the numbers of the scans, if there are any, of the points numbered `chosen`.
void append_scans(const PointCloud& from, std::span<const std::uint32_t> chosen, PointCloud& to);

/// The same for positions, normals and scans.
void append_surface(const PointCloud& from, std::span<const std::uint32_t> chosen, PointCloud& to);

/// Appends the points numbered `chosen`; columns that only `from` has are left out unless `to` has
/// no points yet.
void append_points(const PointCloud& from, std::span<const std::uint32_t> chosen, PointCloud& to);

}  // namespace pcednet::tiles
