#pragma once

#include <string>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::io {

/// The places that comments of the form "scanner INDEX: X Y Z" name; what read_e57 keeps in
/// comments, so that it survives in another format. Those not named are NaN.
std::vector<Vec3> scanners_of_comments(const std::vector<std::string>& comments);

}  // namespace pcednet::io
