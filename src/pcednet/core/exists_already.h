#pragma once

#include <filesystem>

#include "pcednet/core/error.h"

namespace pcednet {

/// Thrown, with ErrorKind::kUsage, where a file would have to be replaced with Overwrite::kNo.
class ExistsAlready : public Error {
 public:
  explicit ExistsAlready(const std::filesystem::path& path)
      : Error(ErrorKind::kUsage, path.string() + ": exists already") {}
};

}  // namespace pcednet
