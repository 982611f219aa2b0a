#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pcednet/study/plan.h"

namespace pcednet::study {

/// The classes of the points of `cloud` that `method` holds; empty if there is no file for it.
/// Throws Error(kUnreadable) for a file that cannot be read, Error(kInsufficient) if its classes
/// are not as many as the points.
std::vector<std::uint8_t> external_classes(const ExternalMethod& method, const std::string& set,
                                           const StudyCloud& cloud);

}  // namespace pcednet::study
