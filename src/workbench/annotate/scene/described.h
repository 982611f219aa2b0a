#pragma once

#include <filesystem>
#include <memory>

#include "pcednet/detect/classify.h"
#include "pcednet/detect/describe.h"

namespace pcednet::annotate {

/// A cloud's description, and its identity.
struct Described {
  gls::ScaleSpaceOptions descriptor = {};
  detect::DescribedCloud cloud = {};
  std::vector<std::uint32_t> row_of = {};  ///< per point; kNoRow where it has no description
  bool from_cache = false;
};

inline constexpr std::uint32_t kNoRow = 0xffffffff;

/// Describes every point, or reads an earlier description from a file in `folder`, which is made if
/// needed (an empty path: no cache). A file that is damaged, or of another cloud, descriptor or
/// version, is replaced; failure to write it is ignored.
std::shared_ptr<const Described> describe_once(const detect::PreparedCloud& cloud,
                                               const gls::ScaleSpaceOptions& descriptor,
                                               const std::filesystem::path& folder,
                                               const Progress* progress = nullptr);

}  // namespace pcednet::annotate
