#include "pcednet/detect/points/far_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "pcednet/core/median.h"

namespace pcednet::detect {
namespace {

constexpr double kFar = 1e12;
constexpr std::size_t kLeast = 3;  ///< other points, in several places, that say what is near

bool is_suspect(const Vec3& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() > kSuspectCoordinate;
}

/// The middle of positions, and the distances from it of those that are elsewhere.
struct Spread {
  Vec3 middle = Vec3::Zero();
  std::vector<double> distances = {};
};

template <typename Condition>
Spread spread_of(std::span<const Vec3> positions, const Condition& is_used) {
  std::vector<Vec3> used;
  std::copy_if(positions.begin(), positions.end(), std::back_inserter(used), is_used);
  if (used.empty()) return {};
  Spread spread{.middle = middle_of(used)};
  for (const Vec3& position : used) {
    if (position != spread.middle) spread.distances.push_back((position - spread.middle).norm());
  }
  return spread;
}

}  // namespace

Vec3 middle_of(std::span<const Vec3> positions) {
  Vec3 middle = Vec3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vec3& position : positions) values.push_back(position[axis]);
    middle[axis] = value_at_rank(values, values.size() / 2);
  }
  return middle;
}

std::vector<std::uint32_t> far_points(std::span<const Vec3> positions) {
  if (std::none_of(positions.begin(), positions.end(), is_suspect)) return {};
  const auto is_finite = [](const Vec3& p) { return p.allFinite(); };
  Spread others =
      spread_of(positions, [&](const Vec3& p) { return is_finite(p) && !is_suspect(p); });
  if (others.distances.size() < kLeast) others = spread_of(positions, is_finite);
  auto& distances = others.distances;
  const double most =
      distances.empty() ? 0.0 : kFar * value_at_rank(distances, distances.size() / 2);
  std::vector<std::uint32_t> far;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (is_suspect(positions[i]) && (positions[i] - others.middle).norm() > most) far.push_back(i);
  }
  return far;
}

std::string note_on_far(std::span<const std::uint32_t> far, std::span<const Vec3> positions) {
  return fmt::format(
      "{} point{} far from all others (the first has a coordinate of {:.6g}): treated as having no "
      "position",
      far.size(), far.size() == 1 ? " is" : "s are", positions[far.front()].cwiseAbs().maxCoeff());
}

}  // namespace pcednet::detect
