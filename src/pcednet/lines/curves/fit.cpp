#include "pcednet/lines/curves/fit.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pcednet/core/eigendecomposition.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostFitted = 48;  ///< of longer runs, as many at even steps
constexpr int kGaussNewtonSteps = 4;
constexpr double kLargestRadius = 1e4;  ///< in spacings: such an arc is a segment

struct Places {
  std::vector<Vec3> at;  ///< relative to the mean, in spacings
  Vec3 mean = Vec3::Zero();
  double spacing = 0.0;
};

Places places_of(std::span<const Vec3> all, double spacing) {
  Places places{.at = {}, .spacing = spacing};
  const std::size_t step = (all.size() + kMostFitted - 1) / kMostFitted;
  for (std::size_t i = 0; i < all.size(); i += step) places.at.push_back(all[i]);
  if ((all.size() - 1) % step != 0) places.at.push_back(all.back());
  for (const Vec3& at : places.at) places.mean += at / static_cast<double>(places.at.size());
  for (Vec3& at : places.at) at = (at - places.mean) / places.spacing;
  return places;
}

std::vector<Vec3> positions_of(std::span<const ChainNode> nodes) {
  std::vector<Vec3> positions;
  positions.reserve(nodes.size());
  for (const ChainNode& node : nodes) positions.push_back(node.at);
  return positions;
}

double mean_spacing_of(std::span<const ChainNode> nodes) {
  double mean = 0.0;
  for (const ChainNode& node : nodes) mean += node.spacing / static_cast<double>(nodes.size());
  return mean;
}

Mat3 principal_axes(const std::vector<Vec3>& places) {
  Mat3 products = Mat3::Zero();
  for (const Vec3& place : places) products += place * place.transpose();
  return eigendecomposition(products / static_cast<double>(places.size())).vectors;
}

struct Circle {
  double x, y, radius;
};

/// The algebraic circle of Kasa.
bool algebraic_circle(const std::vector<Eigen::Vector2d>& places, Circle& circle) {
  Mat3 left = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (const auto& p : places) {
    const Vec3 row(p.x(), p.y(), 1.0);
    left += row * row.transpose();
    right += p.squaredNorm() * row;
  }
  if (std::abs(left.determinant()) < 1e-12) return false;
  const Vec3 solution = left.inverse() * right;
  circle.x = 0.5 * solution[0];
  circle.y = 0.5 * solution[1];
  const double sq_radius = solution[2] + circle.x * circle.x + circle.y * circle.y;
  if (!(sq_radius > 0.0)) return false;
  circle.radius = std::sqrt(sq_radius);
  return circle.radius < kLargestRadius;
}

/// Least squares of distances, from a first circle.
bool improve(const std::vector<Eigen::Vector2d>& places, Circle& circle) {
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    Mat3 left = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (const auto& p : places) {
      const double dx = p.x() - circle.x, dy = p.y() - circle.y;
      const double distance = std::hypot(dx, dy);
      if (distance < 1e-9) return false;
      const Vec3 row(dx / distance, dy / distance, 1.0);
      left += row * row.transpose();
      right += (distance - circle.radius) * row;
    }
    if (std::abs(left.determinant()) < 1e-14) return false;
    const Vec3 change = left.inverse() * right;
    circle.x += change[0];
    circle.y += change[1];
    circle.radius += change[2];
    if (!(circle.radius > 0.0 && circle.radius < kLargestRadius)) return false;
  }
  return true;
}

}  // namespace

Fit fit_segment(std::span<const ChainNode> nodes) {
  const Places places = places_of(positions_of(nodes), mean_spacing_of(nodes));
  if (places.at.size() < 2) {
    return {CurveKind::kSegment, places.mean, nodes.front().along, 0.0, 0.0};
  }
  const Vec3 direction = principal_axes(places.at).col(2);
  double sum = 0.0;
  for (const Vec3& at : places.at) sum += (at - at.dot(direction) * direction).squaredNorm();
  const bool backward = direction.dot(nodes.back().at - nodes.front().at) < 0.0;
  return {CurveKind::kSegment, places.mean, backward ? Vec3(-direction) : direction, 0.0,
          std::sqrt(sum / static_cast<double>(places.at.size()))};
}

Fit fit_arc(std::span<const Vec3> all, double spacing) {
  if (all.size() < 4) return {};
  const Places places = places_of(all, spacing);
  const Mat3 axes = principal_axes(places.at);
  std::vector<Eigen::Vector2d> flat;
  for (const Vec3& at : places.at) flat.emplace_back(axes.col(2).dot(at), axes.col(1).dot(at));
  Circle circle{};
  if (!algebraic_circle(flat, circle) || !improve(flat, circle)) return {};
  double sum = 0.0;
  for (const Vec3& at : places.at) {
    const double out = axes.col(0).dot(at);
    const double off =
        std::hypot(axes.col(2).dot(at) - circle.x, axes.col(1).dot(at) - circle.y) - circle.radius;
    sum += out * out + off * off;
  }
  Fit fit{CurveKind::kArc,
          places.mean + places.spacing * (circle.x * axes.col(2) + circle.y * axes.col(1)),
          axes.col(0), places.spacing * circle.radius,
          std::sqrt(sum / static_cast<double>(places.at.size()))};
  double turn = 0.0;  // of the nodes about the axis
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Vec3 from = all[i - 1] - fit.point, to = all[i] - fit.point;
    turn += fit.direction.dot(from.cross(to));
  }
  if (turn < 0.0) fit.direction = -fit.direction;
  return fit;
}

Fit fit_arc(std::span<const ChainNode> nodes) {
  return fit_arc(positions_of(nodes), mean_spacing_of(nodes));
}

Eigen::Vector2d about_axis(const Fit& circle, const Vec3& place) {
  const Vec3 offset = place - circle.point;
  const double height = offset.dot(circle.direction);
  return {(offset - height * circle.direction).norm(), height};
}

double angle_at(const Fit& circle, const Vec3& x, const Vec3& place) {
  const Vec3 y = circle.direction.cross(x), offset = place - circle.point;
  return std::atan2(y.dot(offset), x.dot(offset));
}

Vec3 nearest_on(const Fit& fit, const Vec3& place) {
  const Vec3 offset = place - fit.point;
  if (fit.kind == CurveKind::kSegment) return fit.point + offset.dot(fit.direction) * fit.direction;
  const Vec3 flat = offset - offset.dot(fit.direction) * fit.direction;
  const double length = flat.norm();
  return length > 0.0 ? Vec3(fit.point + fit.radius / length * flat) : place;
}

Vec3 tangent_at(const Fit& fit, const Vec3& place) {
  if (fit.kind == CurveKind::kSegment) return fit.direction;
  return fit.direction.cross(place - fit.point).normalized();
}

}  // namespace pcednet::lines
