#include "pcednet/lines/exact/apexes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr int kConeFits = 12;
constexpr double kLeastDamping = 1e-9;     ///< of a fit, to a point
constexpr std::size_t kLeastAtApex = 12;   ///< points
constexpr double kMostOffCone = 0.05;      ///< share of the points at an apex
constexpr double kMostBesideOnCone = 0.1;  ///< share of those at a crease that are not on its cone
constexpr std::size_t kLeastAtCrease = 3;  ///< points
constexpr double kLeastConeSine = 0.05, kMostConeSine = 0.98;  ///< of its half angle
constexpr double kLeastSpread = 0.01;  ///< of the directions of creases that meet in a place

// In spacings.
constexpr double kOneCluster = 2.5;  ///< between creases
constexpr double kAroundApex = 6.0, kAroundCrease = 2.0;
constexpr double kOnApexCone = 0.02;

/// A cone that begins at its apex.
struct Cone {
  Vec3 apex, axis;  ///< unit
  double angle;     ///< between axis and surface

  /// The distance of a place from it.
  double off(const Vec3& place) const {
    const Vec3 offset = place - apex;
    const double height = offset.dot(axis);
    const double away = (offset - height * axis).norm();
    return away * std::cos(angle) - height * std::sin(angle);
  }
};

/// Where lines meet, by least squares; none if they are nearly parallel.
std::optional<Vec3> meeting_of(std::span<const Crease* const> creases) {
  Mat3 products = Mat3::Zero();
  Vec3 sums = Vec3::Zero();
  const Vec3& near = creases.front()->at;
  for (const Crease* crease : creases) {
    const Mat3 across = Mat3::Identity() - crease->along * crease->along.transpose();
    products += across;
    sums += across * (crease->at - near);
  }
  products /= static_cast<double>(creases.size());
  sums /= static_cast<double>(creases.size());
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(products, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues()[0] > kLeastSpread)) return std::nullopt;
  return near + products.ldlt().solve(sums);
}

/// Where the apex of a cone may be that has these creases: where they meet, or at an end.
std::vector<Vec3> guesses_of(std::span<const Crease* const> creases) {
  std::vector<Vec3> guesses;
  if (const auto meeting = meeting_of(creases)) guesses.push_back(*meeting);
  const Vec3& along = creases.front()->along;
  const auto [first, last] =
      std::ranges::minmax_element(creases, {}, [&](const Crease* c) { return along.dot(c->at); });
  guesses.push_back((*first)->at);
  guesses.push_back((*last)->at);
  return guesses;
}

/// A step of the fit of a cone to points: of its apex, its axis and its angle.
void improve(Cone& cone, std::span<const Vec3> places) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 sums = Vector6::Zero();
  const Vec3 u = cone.axis.unitOrthogonal(), v = cone.axis.cross(u);
  const double sine = std::sin(cone.angle), cosine = std::cos(cone.angle);
  for (const Vec3& place : places) {
    const Vec3 offset = place - cone.apex;
    const double height = offset.dot(cone.axis);
    const Vec3 across = offset - height * cone.axis;
    const double away = across.norm();
    if (!(away > 0.0)) continue;
    const double turned = -height / away * cosine - sine;
    Vector6 change;
    change << sine * cone.axis - cosine / away * across, turned * offset.dot(u),
        turned * offset.dot(v), -away * sine - height * cosine;
    products += change * change.transpose();
    sums -= cone.off(place) * change;
  }
  products.diagonal().array() += kLeastDamping * static_cast<double>(places.size());
  const Vector6 step = products.ldlt().solve(sums);
  cone.apex += step.head<3>();
  cone.axis = (cone.axis + step[3] * u + step[4] * v).normalized();
  cone.angle += step[5];
}

bool is_cone(const Cone& cone, std::span<const Vec3> places) {
  const double sine = std::sin(cone.angle);
  if (!cone.apex.allFinite() || !(sine > kLeastConeSine && sine < kMostConeSine)) return false;
  const auto off = std::ranges::count_if(
      places, [&](const Vec3& place) { return !(std::abs(cone.off(place)) < kOnApexCone); });
  return static_cast<double>(off) <= kMostOffCone * static_cast<double>(places.size());
}

/// The cone that nearly all points around the place are on.
std::optional<Cone> cone_at(const Vec3& guess, const OrderedPoints& cloud, double spacing) {
  std::vector<spatial::Neighbour> near;
  cloud.within(guess, kAroundApex * spacing, near);
  if (near.size() < kLeastAtApex) return std::nullopt;
  std::vector<Vec3> places;  // in spacings, from the guess
  Vec3 mean = Vec3::Zero();
  for (const auto& point : near) {
    places.push_back((cloud.position(point.index) - guess) / spacing);
    mean += places.back() / static_cast<double>(near.size());
  }
  if (!(mean.norm() > 0.0)) return std::nullopt;
  Cone cone{Vec3::Zero(), mean.normalized(), 0.0};
  for (const Vec3& place : places) {
    const double angle = std::atan2(cone.axis.cross(place).norm(), cone.axis.dot(place));
    cone.angle += angle / static_cast<double>(places.size());
  }
  for (int fit = 0; fit < kConeFits; ++fit) improve(cone, places);
  if (!is_cone(cone, places)) return std::nullopt;
  cone.apex = guess + spacing * cone.apex;
  return cone;
}

bool is_on_cone(const Crease& crease, const Cone& cone, const OrderedPoints& cloud,
                double spacing) {
  std::vector<spatial::Neighbour> near;
  cloud.within(crease.at, kAroundCrease * spacing, near);
  const auto off = std::ranges::count_if(near, [&](const auto& point) {
    return !(std::abs(cone.off(cloud.position(point.index))) < kOnApexCone * spacing);
  });
  return near.size() >= kLeastAtCrease &&
         static_cast<double>(off) <= kMostBesideOnCone * static_cast<double>(near.size());
}

/// The numbers of creases that hang together, ascending, for each cluster.
std::vector<std::vector<std::uint32_t>> clusters_of(const std::vector<Crease>& creases,
                                                    double reach) {
  std::vector<Vec3> places;
  for (const Crease& crease : creases) places.push_back(crease.at);
  const spatial::KdTree tree(places);
  std::vector<std::uint8_t> seen(creases.size(), 0);
  std::vector<spatial::Neighbour> near;
  std::vector<std::vector<std::uint32_t>> clusters;
  for (std::uint32_t i = 0; i < creases.size(); ++i) {
    if (seen[i]) continue;
    seen[i] = 1;
    std::vector<std::uint32_t>& cluster = clusters.emplace_back(1, i);
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      tree.within_unsorted(places[cluster[k]], reach, near);
      for (const auto& other : near) {
        if (!seen[other.index]) seen[other.index] = 1, cluster.push_back(other.index);
      }
    }
    std::sort(cluster.begin(), cluster.end());
  }
  return clusters;
}

}  // namespace

void erase_on_cones(std::vector<Crease>& creases, const OrderedPoints& cloud, double spacing) {
  std::vector<std::uint8_t> is_false(creases.size(), 0);
  for (const auto& cluster : clusters_of(creases, kOneCluster * spacing)) {
    std::vector<const Crease*> members;
    for (const std::uint32_t i : cluster) members.push_back(&creases[i]);
    std::optional<Cone> cone;
    for (const Vec3& guess : guesses_of(members)) {
      if (!cone) cone = cone_at(guess, cloud, spacing);
    }
    if (!cone) continue;
    for (const std::uint32_t i : cluster) {
      is_false[i] = is_on_cone(creases[i], *cone, cloud, spacing);
    }
  }
  std::size_t i = 0;
  std::erase_if(creases, [&](const Crease&) { return is_false[i++] != 0; });
}

}  // namespace pcednet::lines
