#include "pcednet/lines/local_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostPlanes = 4;
constexpr std::size_t kMostSeeds = 16;
constexpr double kLeastSupport = 4.0;
constexpr double kSameDirection = 0.75;  ///< cosine of normals on one plane
constexpr float kTrusted = 0.5f;         ///< edginess below which a normal counts

bool agrees(const LocalPlane& plane, const NearPoint& point) {
  return point.edginess > kTrusted || point.normal.isZero(0.0) ||
         std::abs(plane.normal.dot(point.normal)) > kSameDirection;
}

/// The plane of least squares of the points near `plane`; weights fall to 0 at `reach`.
LocalPlane refit(const LocalPlane& plane, std::span<const NearPoint> points, double reach) {
  double sum = 0.0;
  Vec3 mean = Vec3::Zero();
  Mat3 products = Mat3::Zero();
  for (const NearPoint& point : points) {
    const double part = plane(point.offset) / reach;
    if (part * part >= 1.0 || !agrees(plane, point)) continue;
    const double weight = (1.0 - part * part) * (1.0 - part * part);
    sum += weight;
    mean += weight * point.offset;
    products += weight * point.offset * point.offset.transpose();
  }
  if (sum < 3.0) return plane;
  mean /= sum;
  const Mat3 covariance = products / sum - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(covariance);
  const auto& sizes = solver.eigenvalues();
  if (!(sizes[1] > 0.04)) return plane;  // a row of points has many planes
  const Vec3 normal = solver.eigenvectors().col(0).normalized();
  return {normal, normal.dot(mean), plane.support};
}

double support_of(const LocalPlane& plane, std::span<const NearPoint> points,
                  std::span<const std::uint8_t> taken, double tolerance) {
  double support = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (taken[i] || std::abs(plane(points[i].offset)) > tolerance) continue;
    if (agrees(plane, points[i])) support += 1.0;
  }
  return support;
}

}  // namespace

void find_planes(std::span<const NearPoint> points, double tolerance,
                 std::vector<LocalPlane>& planes) {
  planes.clear();
  std::vector<std::uint8_t> taken(points.size(), 0);
  std::vector<std::size_t> seeds;
  while (planes.size() < kMostPlanes) {
    seeds.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!taken[i] && !points[i].normal.isZero(0.0)) seeds.push_back(i);
    }
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
      return points[a].edginess < points[b].edginess;
    });
    if (seeds.size() > kMostSeeds) seeds.resize(kMostSeeds);
    LocalPlane best{Vec3::Zero(), 0.0, 0.0};
    for (const std::size_t seed : seeds) {
      const Vec3& normal = points[seed].normal;
      LocalPlane plane{normal, normal.dot(points[seed].offset), 0.0};
      plane.support = support_of(plane, points, taken, tolerance);
      if (plane.support > best.support) best = plane;
    }
    if (best.support < kLeastSupport) break;
    LocalPlane fitted = refit(refit(best, points, 2.0 * tolerance), points, 1.5 * tolerance);
    fitted.support = support_of(fitted, points, taken, tolerance);
    if (fitted.support < best.support) fitted = best;
    for (std::size_t i = 0; i < points.size(); ++i) {
      taken[i] |= std::abs(fitted(points[i].offset)) < 1.3 * tolerance;
    }
    planes.push_back(fitted);
  }
}

}  // namespace pcednet::lines
