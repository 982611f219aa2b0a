#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

struct Joined {
  std::size_t points = 0;
  std::vector<std::string> losses;  ///< the data that the format does not keep, as phrases
};

/// Throws Error(kInsufficient) with the numbers of the tiles that are missing or damaged, if any
/// are.
void check_all_done(const Plan& plan);

/// Throws Error(kUsage) for a file in whose format tiles are not joined.
void check_joins(const std::filesystem::path& path);

/// Writes all tiles into one file, tile after tile, in memory that does not grow with them. Throws
/// as check_all_done() and OutputFile do, Error(kFailure) if the points are not those planned, and
/// Error(kUsage) for formats other than .laz, .las and .ply.
Joined join(const Plan& plan, const std::filesystem::path& path, Overwrite overwrite,
            const Progress* progress = nullptr);

struct NumberRange {
  std::size_t first, last;
};

/// Numbers that follow each other, as ranges.
std::vector<NumberRange> ranges_of(const std::vector<std::size_t>& numbers);

/// "0, 3, 5 to 9": no more than the first ranges.
std::string list_of(const std::vector<std::size_t>& numbers);

}  // namespace pcednet::tiles
