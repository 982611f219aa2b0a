#include "workbench/annotate/depth_buffer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pcednet::annotate {
namespace {

constexpr double kCell = 2;         // pixels a side
constexpr double kMostRadius = 48;  // pixels: close to the eye there are few points
constexpr double kSlope = 3;        // how steeply a surface may run away within a square

}  // namespace

View::View(const std::array<double, 16>& matrix, const std::array<double, 2>& viewport)
    : matrix_(Eigen::Map<const Eigen::Matrix4d>(matrix.data())), viewport_(viewport) {
  const double w_scale = matrix_.row(3).head<3>().norm();
  perspective_ = w_scale > 0;
  depth_scale_ = perspective_ ? w_scale : matrix_.row(2).head<3>().norm();
  x_scale_ = matrix_.row(0).head<3>().norm();
}

ViewedPoint View::see(const Vec3& local) const {
  const Eigen::Vector4d clip = matrix_ * Eigen::Vector4d(local.x(), local.y(), local.z(), 1.0);
  const double w = clip.w();
  if (!(w > 0) || (clip.head<3>().array().abs() > w).any()) return {};
  return {.x = clip.x() / w,
          .y = clip.y() / w,
          .depth = (perspective_ ? w : clip.z()) / std::max(depth_scale_, 1e-300),
          .visible = true};
}

double View::pixels_per_unit(double depth) const {
  const double w = perspective_ ? depth * depth_scale_ : 1.0;
  return 0.5 * viewport_[0] * x_scale_ / std::max(w, 1e-300);
}

DepthBuffer::DepthBuffer(const View& view, double point_size, double spacing)
    : view_(view),
      point_size_(point_size),
      spacing_(spacing),
      width_(static_cast<std::ptrdiff_t>(view.viewport()[0] / kCell) + 1),
      height_(static_cast<std::ptrdiff_t>(view.viewport()[1] / kCell) + 1),
      nearest_(static_cast<std::size_t>(width_ * height_), std::numeric_limits<float>::infinity()) {
}

double DepthBuffer::radius(const ViewedPoint& point) const {
  return std::min(std::max(0.5 * point_size_, spacing_ * view_.pixels_per_unit(point.depth)),
                  kMostRadius);
}

void DepthBuffer::add(const ViewedPoint& point) {
  const double r = radius(point);
  const double x = 0.5 * (point.x + 1) * view_.viewport()[0];
  const double y = 0.5 * (point.y + 1) * view_.viewport()[1];
  const auto cell = [](double pixel, std::ptrdiff_t cells) {
    return std::clamp(static_cast<std::ptrdiff_t>(std::floor(pixel / kCell)), std::ptrdiff_t{0},
                      cells - 1);
  };
  const auto depth = static_cast<float>(point.depth);
  for (std::ptrdiff_t j = cell(y - r, height_); j <= cell(y + r, height_); ++j) {
    for (std::ptrdiff_t i = cell(x - r, width_); i <= cell(x + r, width_); ++i) {
      float& nearest = nearest_[static_cast<std::size_t>(j * width_ + i)];
      nearest = std::min(nearest, depth);
    }
  }
}

bool DepthBuffer::covers(const ViewedPoint& point) const {
  const auto i = static_cast<std::ptrdiff_t>(0.5 * (point.x + 1) * view_.viewport()[0] / kCell);
  const auto j = static_cast<std::ptrdiff_t>(0.5 * (point.y + 1) * view_.viewport()[1] / kCell);
  const std::ptrdiff_t cell = std::clamp(j, std::ptrdiff_t{0}, height_ - 1) * width_ +
                              std::clamp(i, std::ptrdiff_t{0}, width_ - 1);
  const double square = (radius(point) + kCell) / view_.pixels_per_unit(point.depth);
  return point.depth > nearest_[static_cast<std::size_t>(cell)] + kSlope * square;
}

}  // namespace pcednet::annotate
