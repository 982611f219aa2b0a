#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "pcednet/io/loaded_cloud.h"

namespace pcednet::truth {

/// A point file with labels, read as by read_cloud(). Missing labels come from the ABC features of
/// an OBJ (find_abc_features) or from the colours (labels_of_colours), with a warning. Of a result
/// of pcednet they are those that were painted or those of its input, with a warning. Throws
/// Error(kInsufficient), naming the file, if there are none, and as the readers do. An empty file
/// gives an empty cloud.
io::LoadedCloud read_labelled(const std::filesystem::path& path);

/// Pairs of a class and a code of the LAS field Classification that stands for it.
using LabelCodes = std::vector<std::pair<std::uint8_t, std::uint8_t>>;

/// A point file whose labels are in its field Classification, of any format; points of other codes
/// are unlabelled. Without codes, read_labelled(). Throws Error(kInsufficient), naming the file, if
/// it has no such field, or no point of these codes, and as the readers do.
io::LoadedCloud read_labelled(const std::filesystem::path& path, const LabelCodes& codes);

/// These labels of a cloud that was read, with points. Throws as that.
std::vector<std::uint8_t> coded_labels(const PointCloud& cloud, const LabelCodes& codes,
                                       const std::filesystem::path& path);

/// The same of a part of a cloud, of which all may be unlabelled.
std::vector<std::uint8_t> coded_labels_of_part(const PointCloud& part, const LabelCodes& codes,
                                               const std::filesystem::path& path);

}  // namespace pcednet::truth
