#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "pcednet/detect/classify.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// What stands beside a finished tile, in a file of its name with .json after it.
struct TileRecord {
  std::string plan = {};  ///< digest of the plan's file
  std::size_t tile = 0;
  std::size_t points = 0;
  std::uint64_t bytes = 0;  ///< of the tile
  std::string sha256 = {};  ///< of its bytes
  detect::ClassCounts counts = {};
};

/// The record that the file of a tile, finished and in its place, deserves. The tile's file is
/// written first, its record after it: a tile without one is not finished.
void write_record(const std::filesystem::path& tile, TileRecord record);

/// None where there is none, or no sound one.
std::optional<TileRecord> read_record(const std::filesystem::path& tile);

enum class TileState { kMissing, kDamaged, kDone };

/// Whether a tile is finished: its record is of this plan, and its file has the size, and where
/// `look_inside` the digest, that the record says. Times of files say nothing.
TileState state_of(const Plan& plan, std::size_t tile, bool look_inside = false);

}  // namespace pcednet::tiles
