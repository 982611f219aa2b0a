#pragma once

#include <Eigen/Core>
#include <span>

#include "workbench/render/surfels.h"

namespace pcednet::render {

/// A pinhole camera. Camera space: x right, y up, z the depth along the line of sight.
struct Camera {
  Eigen::Matrix3f axes;  ///< rows: right, up, forward
  Eigen::Vector3f eye;
  float focal;  ///< pixels
  int width, height;

  Eigen::Vector3f to_camera(const Eigen::Vector3f& position) const {
    return axes * (position - eye);
  }
};

/// A camera that looks along `direction` (not zero) and stands where the surfels fill the picture,
/// but for a few that lie far off.
Camera frame(std::span<const Surfel> surfels, const Eigen::Vector3f& direction, int width,
             int height);

/// Where to look to see much of the surface from outside, much of its edges, preferably a little
/// from above. `surfels` should be few (thousands): each is drawn from every candidate.
Eigen::Vector3f best_direction(std::span<const Surfel> surfels);

}  // namespace pcednet::render
