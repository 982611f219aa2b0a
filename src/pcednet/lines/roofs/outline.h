#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace pcednet::lines {

/// A point of an outline.
struct OutlinePoint {
  std::size_t index;
  Eigen::Vector2d
      outward;  ///< unit: towards the middle of the positions where the disc rests on the point
};

/// The chains of points that a disc of this radius touches as it rolls around the points of a
/// plane, outside and in holes: the corners of their alpha shape. Points without others nearer
/// than the diameter are left out; points must be distinct.
std::vector<std::vector<OutlinePoint>> outlines(std::span<const Eigen::Vector2d> points,
                                                double radius);

}  // namespace pcednet::lines
