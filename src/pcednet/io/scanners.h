#pragma once

#include <string>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::io {

/// The positions in comments of the form "scanner INDEX: X Y Z", where read_e57() keeps them so
/// that they survive in other formats. Unnamed ones are NaN.
std::vector<Vec3> scanners_of_comments(const std::vector<std::string>& comments);

}  // namespace pcednet::io
