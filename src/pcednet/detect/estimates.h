#pragma once

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"

namespace pcednet::detect {

/// Whether a result has lost its comments in another program, see kResultColumns: then it does not
/// say whether its normals are estimates. Needs no points.
bool has_lost_comments(const PointCloud& outline);

/// Whether the normals are estimates of prepare(): nine in ten are those that it makes of the
/// positions, up to their sign and 3 degrees, for programs round them. In thick noise 20 degrees
/// count as the same: a part of the cloud has other averages, and nothing measures its normals. Not
/// of points without noise, whose true normals may be as those.
bool are_estimates(const PointCloud& cloud, const Progress* progress = nullptr);

/// Gives a result that has lost its comments the one of estimated normals, if they are.
void mark_estimates(PointCloud& cloud, const Progress* progress = nullptr);

}  // namespace pcednet::detect
