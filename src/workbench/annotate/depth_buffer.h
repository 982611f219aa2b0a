#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::annotate {

/// Where a point appears: x and y in clip space, and its distance along the view.
struct ViewedPoint {
  double x = 0, y = 0, depth = 0;
  bool visible = false;  ///< within the view's frustum
};

/// A camera as a page defines it: a column-major matrix to clip space, and the size of its picture
/// in pixels.
class View {
 public:
  View(const std::array<double, 16>& matrix, const std::array<double, 2>& viewport);

  ViewedPoint see(const Vec3& local) const;

  /// Pixels that a unit of length covers at `depth`.
  double pixels_per_unit(double depth) const;

  const std::array<double, 2>& viewport() const { return viewport_; }

 private:
  Eigen::Matrix4d matrix_;
  std::array<double, 2> viewport_;
  bool perspective_;
  double depth_scale_, x_scale_;
};

/// A z-buffer of a picture's cells, of points drawn as squares large enough to close the surface
/// between neighbours.
class DepthBuffer {
 public:
  DepthBuffer(const View& view, double point_size, double spacing);

  void add(const ViewedPoint& point);

  /// Whether something is clearly in front of `point`.
  bool covers(const ViewedPoint& point) const;

 private:
  double radius(const ViewedPoint& point) const;  ///< pixels

  const View& view_;
  double point_size_, spacing_;
  std::ptrdiff_t width_, height_;  ///< cells
  std::vector<float> nearest_;
};

}  // namespace pcednet::annotate
