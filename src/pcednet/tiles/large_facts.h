#pragma once

#include <filesystem>
#include <optional>

#include "pcednet/core/progress.h"
#include "pcednet/formats/cloud_facts.h"

namespace pcednet::tiles {

struct FactsOptions {
  std::size_t large = 2'000'000;  ///< only for files with more points
  bool all = false;               ///< read them all, in bounded memory, twice for the spacing
};

/// The formats::cloud_facts() of a large LAS, LAZ or binary PLY file; none for others.
///
/// Unless all points are read, the facts are those of parts at equal steps of the file, except for
/// the number of points and, in LAS, their bounds. The spacing is then measured within each part,
/// and left out if parts overlap, as those of an unordered file do. Throws as read_cloud(), and
/// Error(kCancelled) when `progress` asks to cancel.
std::optional<formats::CloudFacts> large_facts(const std::filesystem::path& path,
                                               const FactsOptions& options,
                                               const Progress* progress = nullptr);

}  // namespace pcednet::tiles
