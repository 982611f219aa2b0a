#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "pcednet/detect/classify.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// The record of a finished tile, in a file of its name with .json appended.
struct TileRecord {
  std::string plan = {};  ///< digest of the plan's file
  std::size_t tile = 0;
  std::size_t points = 0;
  std::uint64_t bytes = 0;  ///< of the tile
  std::string sha256 = {};  ///< of its bytes
  detect::ClassCounts counts = {};
};

/// Writes the record of a tile whose file is finished and in place. The tile's file is written
/// first, then its record: a tile without one is not finished. Throws Error(kUnreadable) if the
/// file is gone.
void write_record(const std::filesystem::path& tile, TileRecord record);

/// Marks a tile as begun, so that a file at its path is recognised as a tile.
void write_claim(const std::filesystem::path& tile, TileRecord record);
/// Removes it if there is no such file.
void remove_claim(const std::filesystem::path& tile);

/// Throws Error(kUsage) if the output is a file that the plan needs: an input, its model, a tile or
/// the record of one.
void check_not_of_plan(const std::filesystem::path& output, const Plan& plan);

/// A file that occupies the tile's or its record's name without a valid record; empty if there is
/// none.
std::filesystem::path strange_file(const std::filesystem::path& tile);

/// A tile in the folder whose record is of another plan than that of this digest; empty if there is
/// none.
std::filesystem::path tile_of_another_plan(const std::filesystem::path& folder,
                                           const std::string& digest);

enum class TileState { kMissing, kDamaged, kDone };

/// Whether a tile is finished: its record is of this plan, and its file has the size and, with
/// `look_inside`, the digest in the record. File times do not count.
TileState state_of(const Plan& plan, std::size_t tile, bool look_inside = false);

}  // namespace pcednet::tiles
