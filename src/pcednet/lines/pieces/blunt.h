#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcednet::lines {

/// Where an edge is whose surfaces, seen along it, leave a corner in these directions (unit): in
/// the corner, or, where a chamfer or a fillet blunts it, among the points there. These are seen
/// from the corner; all lengths are in spacings.
Eigen::Vector2d blunted(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b);

}  // namespace pcednet::lines
