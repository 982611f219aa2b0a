#pragma once

#include <cstddef>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::tiles {

/// The content beside points, and the columns, of tiles whose points come from several forms of
/// LAS, each given without points: io::merge_las_files(), and the comments of the first. GPS times
/// count as in number `timed` of them.
PointCloud merge_outlines(std::vector<PointCloud> outlines, std::size_t timed);

/// Gives a part that comes from LAS the columns of the outline, in their order: 0 where it has
/// none, scan angles in the unit of the outline.
void take_columns(const PointCloud& outline, PointCloud& part);

}  // namespace pcednet::tiles
