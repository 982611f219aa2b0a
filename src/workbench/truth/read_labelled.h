#pragma once

#include <filesystem>

#include "pcednet/io/loaded_cloud.h"

namespace pcednet::truth {

/// A point file with labels, read as by read_cloud(). Missing labels come from the ABC features of
/// an OBJ (find_abc_features) or from the colours (labels_of_colours), with a warning. Of a result
/// of pcednet they are those that were painted or those of its input, with a warning. Throws
/// Error(kInsufficient), naming the file, if there are none, and as the readers do. An empty file
/// gives an empty cloud.
io::LoadedCloud read_labelled(const std::filesystem::path& path);

}  // namespace pcednet::truth
