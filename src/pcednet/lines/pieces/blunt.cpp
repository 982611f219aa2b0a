#include "pcednet/lines/pieces/blunt.h"

#include <algorithm>
#include <cmath>

namespace pcednet::lines {
namespace {

constexpr double kAtEdge = 0.3;     ///< of the points at the edge, and a spacing on the surfaces
constexpr double kFromBlunt = 3.0;  ///< of these points
constexpr std::size_t kLeastAtEdge = 8;
constexpr double kLeastBlunt = 0.35, kMostBlunt = 2.0;

}  // namespace

Eigen::Vector2d blunted(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
  const Eigen::Vector2d inward = (a + b).normalized(), across(-inward.y(), inward.x());
  const double cosine = inward.dot(a), sine = std::abs(across.dot(a));
  if (!(sine > 0.0)) return Eigen::Vector2d::Zero();
  std::vector<double> depths;  // below the surfaces
  for (const Eigen::Vector2d& point : points) {
    const double beside = std::abs(point.dot(across)), depth = point.dot(inward);
    if (beside > kAtEdge + sine || std::abs(depth) > kFromBlunt) continue;
    depths.push_back(depth - beside * cosine / sine);
  }
  if (depths.size() < kLeastAtEdge) return Eigen::Vector2d::Zero();
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  if (*middle < kLeastBlunt) return Eigen::Vector2d::Zero();
  return std::min(*middle, kMostBlunt) * inward;
}

}  // namespace pcednet::lines
