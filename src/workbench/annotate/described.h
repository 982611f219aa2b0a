#pragma once

#include <filesystem>
#include <memory>

#include "pcednet/detect/classify.h"
#include "pcednet/detect/describe.h"

namespace pcednet::annotate {

/// A cloud's description, and which one it is.
struct Described {
  gls::ScaleSpaceOptions descriptor = {};
  detect::DescribedCloud cloud = {};
  std::vector<std::uint32_t> row_of = {};  ///< per point; kNoRow where it has no description
  bool from_cache = false;
};

inline constexpr std::uint32_t kNoRow = 0xffffffff;

/// Describes every point, or reads what was described before from a file in `folder`, which is made
/// if need be (an empty path: no cache). A file that is damaged, or of another cloud, descriptor or
/// version, is replaced; one that cannot be written is left out.
std::shared_ptr<const Described> describe_once(const detect::PreparedCloud& cloud,
                                               const gls::ScaleSpaceOptions& descriptor,
                                               const std::filesystem::path& folder,
                                               const Progress* progress = nullptr);

}  // namespace pcednet::annotate
