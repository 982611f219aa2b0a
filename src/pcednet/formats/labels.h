#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::formats {

/// Reads one label per point, an EdgeClass each: .u8 (a byte per point); a text with one whole
/// number a line (.txt, .csv, .lbl, .seg; -1 is unlabelled); or any point file, see labels_of.
/// Throws Error(kUnreadable) like read_cloud, Error(kInsufficient) for a point file without labels.
std::vector<std::uint8_t> read_labels(const std::filesystem::path& path);

/// The classes that `cloud` carries: its attribute scalar_edge_class or edge_class, which a
/// classification leaves, otherwise its labels; empty if it has neither. Throws
/// Error(kInsufficient), naming `path`, if that attribute holds numbers outside 0 ... 255.
std::vector<std::uint8_t> labels_of(const PointCloud& cloud, const std::filesystem::path& path);

}  // namespace pcednet::formats
