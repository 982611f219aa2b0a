#include "pcednet/lines/creases/plane_wedge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::lines {
namespace {

constexpr WedgeTolerances kTolerances = {.plane = 0.3, .first = 2.0, .noise = 0.0};
constexpr double kHalfTurn = std::numbers::pi;

/// Where a profile, which is extended along y, is at a length from its start, and its normal there.
struct Place {
  Vec3 at, normal;
};

/// The 40 points of a profile that are nearest to its point at `from`, one to a square; the profile
/// is sampled 8 spacings to both sides.
template <typename Profile>
NearPoints points_of(std::uint64_t seed, double from, const Profile& profile) {
  Random random(seed);
  std::vector<Place> places;
  const Vec3 centre = profile(from).at;
  for (int i = 0; i < 16 * 16; ++i) {
    Place place = profile(from + random.uniform(-8.0, 8.0));
    place.at.y() = random.uniform(-8.0, 8.0);
    place.at -= centre;
    places.push_back(place);
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.at.squaredNorm() < b.at.squaredNorm(); });
  NearPoints points;
  points.add(Vec3::Zero(), profile(from).normal, 1.0);
  for (const Place& place : std::vector(places.begin(), places.begin() + 39)) {
    points.add(place.at, place.normal, 0.0);
  }
  return points;
}

/// A floor, up to 0; a slope of 45 degrees as long as `width`; a wall.
Place chamfered(double width, double length) {
  const Vec3 slope = Vec3(1.0, 0.0, 1.0).normalized();
  const Vec3 normal = Vec3(-1.0, 0.0, 1.0).normalized();
  if (length < 0.0) return {length * Vec3::UnitX(), Vec3::UnitZ()};
  if (length < width) return {length * slope, normal};
  return {width * slope + (length - width) * Vec3::UnitZ(), -Vec3::UnitX()};
}

/// The same with the normals that are estimated: the mean over 1.5 spacings to both sides.
Place with_mean_normal(double width, double length) {
  Place place = chamfered(width, length);
  place.normal = Vec3::Zero();
  for (const double away : {-1.5, -0.75, 0.0, 0.75, 1.5}) {
    place.normal += chamfered(width, length + away).normal;
  }
  place.normal.normalize();
  return place;
}

/// The share of 40 samples in which the wedge at the foot of the chamfer is that of floor and
/// slope.
template <typename Profile>
double share_at_foot(const Profile& profile, double noise) {
  WedgeTolerances within = kTolerances;
  within.noise = noise;
  int found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto wedge = best_plane_wedge(points_of(seed, 0.0, profile), within);
    if (!wedge) continue;
    const Vec3 away = wedge->at - wedge->at.y() * Vec3::UnitY();
    const double bend = std::acos(std::clamp(-wedge->side_a.dot(wedge->side_b), -1.0, 1.0));
    found += away.norm() < 0.1 && std::abs(bend - 0.25 * kHalfTurn) < 0.05;
  }
  return found / 40.0;
}

TEST(PlaneWedge, IsAtTheFootOfAChamferOfTwoSpacingsAndNotWhereFloorAndWallWouldMeet) {
  for (const auto& [width, least] : {std::pair(1.8, 0.6), std::pair(5.0, 0.9)}) {
    const auto profile = [wide = width](double length) { return chamfered(wide, length); };
    EXPECT_GT(share_at_foot(profile, 0.0), least) << width;
  }
}

TEST(PlaneWedge, OfExactPointsIsSoughtAmongSmallPlanesButNotOfMeasuredOnesAsInTrees) {
  const auto profile = [](double length) { return with_mean_normal(1.8, length); };
  EXPECT_GT(share_at_foot(profile, 0.0), 0.5);
  EXPECT_LT(share_at_foot(profile, 0.01), 0.2);
}

TEST(PlaneWedge, IsWhereFloorAndWallWouldMeetBeyondANarrowFillet) {
  constexpr double kRadius = 1.0;
  const auto fillet = [&](double length) -> Place {
    const double turn = length / kRadius;
    if (turn < 0.0) return {length * Vec3::UnitX(), Vec3::UnitZ()};
    if (turn > 0.5 * kHalfTurn) {
      const double rest = length - 0.5 * kHalfTurn * kRadius;
      return {Vec3(kRadius, 0.0, kRadius + rest), -Vec3::UnitX()};
    }
    return {kRadius * Vec3(std::sin(turn), 0.0, 1.0 - std::cos(turn)),
            Vec3(-std::sin(turn), 0.0, std::cos(turn))};
  };
  int found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto wedge = best_plane_wedge(points_of(seed, 0.8, fillet), kTolerances);
    if (!wedge) continue;
    const Vec3 meeting = Vec3(kRadius, 0.0, 0.0) - fillet(0.8).at;
    const Vec3 away = wedge->at - meeting;
    found += std::hypot(away.x(), away.z()) < 0.3;
  }
  EXPECT_GT(found, 30);
}

TEST(PlaneWedge, IsNotOnARoundedSurface) {
  for (const double radius : {10.0, 15.0}) {
    int found = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const auto points = points_of(seed, 0.0, [&](double length) -> Place {
        const double turn = length / radius;
        const Vec3 normal(-std::sin(turn), 0.0, std::cos(turn));
        return {radius * (Vec3::UnitZ() - normal), normal};
      });
      found += best_plane_wedge(points, kTolerances).has_value();
    }
    EXPECT_LE(found, 4) << radius;
  }
}

}  // namespace
}  // namespace pcednet::lines
