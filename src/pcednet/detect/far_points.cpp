#include "pcednet/detect/far_points.h"

#include <algorithm>

#include "pcednet/core/median.h"

namespace pcednet::detect {
namespace {

constexpr double kSuspect = 1e15, kFar = 1e12;

/// The middle values of the coordinates of finite positions.
Vec3 middle_of(std::span<const Vec3> positions) {
  Vec3 middle = Vec3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vec3& position : positions) {
      if (position.allFinite()) values.push_back(position[axis]);
    }
    middle[axis] = value_at_rank(values, values.size() / 2);
  }
  return middle;
}

}  // namespace

std::vector<std::uint32_t> far_points(std::span<const Vec3> positions) {
  const bool suspect = std::any_of(positions.begin(), positions.end(), [](const Vec3& position) {
    return position.allFinite() && position.cwiseAbs().maxCoeff() > kSuspect;
  });
  if (!suspect) return {};
  const Vec3 middle = middle_of(positions);
  std::vector<double> distances;
  for (const Vec3& position : positions) {
    if (position.allFinite()) distances.push_back((position - middle).norm());
  }
  const double most = kFar * value_at_rank(distances, distances.size() / 2);
  std::vector<std::uint32_t> far;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (positions[i].allFinite() && (positions[i] - middle).norm() > most) far.push_back(i);
  }
  return far;
}

}  // namespace pcednet::detect
