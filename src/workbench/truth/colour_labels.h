#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::truth {

/// The classes that colours mean in clouds published with painted results: greys non-edge, yellows
/// and oranges smooth-edge, reds sharp-edge, as in the figures of Himeur et al. 2021. Empty unless
/// the cloud has two or three colours, one of which is a red, and each means another class.
std::vector<std::uint8_t> labels_of_colours(const PointCloud& cloud);

}  // namespace pcednet::truth
