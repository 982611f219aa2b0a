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

/// A camera that looks along `direction` (not zero) from a distance at which the surfels, except a
/// few far outliers, fill the picture.
Camera frame(std::span<const Surfel> surfels, const Eigen::Vector3f& direction, int width,
             int height);

/// The viewing direction that shows most of the surface from outside and of its edges, preferably
/// a little from above. `surfels` should be few (thousands): every candidate draws all of them.
Eigen::Vector3f best_direction(std::span<const Surfel> surfels);

}  // namespace pcednet::render
