#pragma once

#include <vector>

#include "pcednet/io/e57/header.h"

namespace pcednet::io {

/// Throws Error(kUnreadable) unless the pages have room for all points that the scans declare.
void check_e57_sizes(const E57Pages& pages, const std::vector<E57Scan>& scans);

/// The fields of all points of a scan, one attribute per field and in its type, in file order;
/// string fields stay empty. Reserves memory for the declared points: see check_e57_sizes(). Throws
/// Error(kUnreadable), naming the scan and the byte, where its packets are damaged.
std::vector<Attribute> read_e57_points(const E57Pages& pages, const E57Scan& scan);

}  // namespace pcednet::io
