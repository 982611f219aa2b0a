#pragma once

#include <filesystem>

#include "pcednet/core/error.h"

namespace pcednet {

/// Thrown, with ErrorKind::kUsage, when Overwrite::kNo forbids replacing a file.
class ExistsAlready : public Error {
 public:
  explicit ExistsAlready(const std::filesystem::path& path)
      : Error(ErrorKind::kUsage, path.string() + ": exists already") {}
};

}  // namespace pcednet
