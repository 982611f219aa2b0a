#pragma once

#include <filesystem>
#include <optional>

#include "pcednet/core/progress.h"
#include "pcednet/formats/cloud_facts.h"

namespace pcednet::tiles {

struct FactsOptions {
  std::size_t large = 2'000'000;  ///< points of which there must be more
  bool all = false;               ///< read them all, in bounded memory, twice for the spacing
};

/// What formats::cloud_facts() finds, of a large LAS, LAZ or binary PLY file; nothing for others.
///
/// Unless all are read, the facts are those of parts at equal steps of the file, but for the number
/// of points and, in LAS, their bounds. The spacing is then found within each part, and left out if
/// parts lie in one another, as those of a file in no order do.
/// Throws as read_cloud, Error(kCancelled) when `progress` says so.
std::optional<formats::CloudFacts> large_facts(const std::filesystem::path& path,
                                               const FactsOptions& options,
                                               const Progress* progress = nullptr);

}  // namespace pcednet::tiles
