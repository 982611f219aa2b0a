#pragma once

#include <filesystem>

#include "pcednet/io/loaded_cloud.h"

namespace pcednet::truth {

/// A point file with labels, as read_cloud() reads it. Where it has no labels of its own, they come
/// from the ABC features of an OBJ (find_abc_features), or from the colours (labels_of_colours); a
/// warning says so. Throws Error(kInsufficient), naming the file, if there are none, and what the
/// readers throw. An empty file gives an empty cloud.
io::LoadedCloud read_labelled(const std::filesystem::path& path);

}  // namespace pcednet::truth
