#pragma once

#include <string>

#include "pcednet/core/error.h"

namespace pcednet::annotate {

/// The request names something that does not exist: a node, a run, a place.
class NotFound : public Error {
 public:
  explicit NotFound(const std::string& message) : Error(ErrorKind::kUsage, message) {}
};

}  // namespace pcednet::annotate
