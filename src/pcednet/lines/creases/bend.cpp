#include "pcednet/lines/creases/bend.h"

#include <Eigen/Geometry>

#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/creases/plane_wedge.h"
#include "pcednet/lines/points/lanes.h"

namespace pcednet::lines {
namespace {

/// Ends of the zones of a side: near the line, between, far; in spacings.
constexpr double kNearZone[] = {0.15, 0.9}, kMiddleZone = 1.9, kFarZone = 3.3;

/// A point is of the other side if its height over that is less than this share of its own: where
/// the sides meet at an acute angle, each is above the other. A fillet between sides at a right
/// angle has no such points in the zones.
constexpr double kOfOtherSide = 0.25;
constexpr double kOnOtherSide = 0.06;  ///< and less than this, in spacings

/// Sums of heights over the points of a side that are near the line, beyond and far from it.
struct ZoneSums {
  double height[3], count[3];
};

PCEDNET_VECTOR_CLONES
ZoneSums sum_zones(const Vec3& at, const Vec3& along, const Vec3& side, const Vec3& inward,
                   const Vec3& above_other, const NearPoints& points, double most_height) {
  const double ends[4] = {kNearZone[0], kNearZone[1], kMiddleZone, kFarZone};
  const double at_x = at.x(), at_y = at.y(), at_z = at.z();
  const double along_x = along.x(), along_y = along.y(), along_z = along.z();
  const double side_x = side.x(), side_y = side.y(), side_z = side.z();
  const double up_x = inward.x(), up_y = inward.y(), up_z = inward.z();
  const double other_x = above_other.x(), other_y = above_other.y(), other_z = above_other.z();
  Lanes heights[3] = {}, counts[3] = {};
  Lanes number = {0.0, 1.0, 2.0, 3.0};
  const Lanes zero = {}, one = zero + 1.0;
  const auto count = static_cast<double>(points.count);
  for (std::size_t i = 0; i < points.count; i += kLanes, number += static_cast<double>(kLanes)) {
    Lanes x, y, z;
    load(&points.x[i], x);
    load(&points.y[i], y);
    load(&points.z[i], z);
    x -= at_x, y -= at_y, z -= at_z;
    const Lanes lengthwise = x * along_x + y * along_y + z * along_z;
    const Lanes place = x * side_x + y * side_y + z * side_z;
    const Lanes height = x * up_x + y * up_y + z * up_z;
    const Lanes share = kOfOtherSide * height;
    const Lanes over_other = x * other_x + y * other_y + z * other_z;
    const auto is_of_other = (over_other < share) & (over_other > -share) &
                             (over_other < kOnOtherSide) & (over_other > -kOnOtherSide);
    const auto is_near = (lengthwise <= kSliceAlong) & (lengthwise >= -kSliceAlong) &
                         (height <= most_height) & (height >= -most_height) & (number < count) &
                         ~is_of_other;
    for (int k = 0; k < 3; ++k) {
      const auto in_zone = is_near & (place >= ends[k]) & (place < ends[k + 1]);
      heights[k] += in_zone ? height : zero;
      counts[k] += in_zone ? one : zero;
    }
  }
  ZoneSums sums;
  for (int k = 0; k < 3; ++k) {
    sums.height[k] = sum_of(heights[k]);
    sums.count[k] = sum_of(counts[k]);
  }
  return sums;
}

/// How much the points of a side bend towards the inside of the wedge: their mean distance to the
/// plane near the line and far from it, less that between.
double bend_of_side(const Vec3& at, const Vec3& along, const Vec3& side, const Vec3& inward,
                    const Vec3& above_other, const NearPoints& points, double tolerance) {
  const ZoneSums sums = sum_zones(at, along, side, inward, above_other, points, tolerance + 0.3);
  if (sums.count[1] == 0.0) return 0.0;
  const double middle = sums.height[1] / sums.count[1];
  double bend = 0.0;
  for (const int zone : {0, 2}) {
    if (sums.count[zone] > 0.0) bend += sums.height[zone] / sums.count[zone] - middle;
  }
  return bend;
}

}  // namespace

double bend_of(const Wedge& wedge, const NearPoints& points, double tolerance) {
  Vec3 into_a = wedge.along.cross(wedge.side_a), into_b = wedge.along.cross(wedge.side_b);
  if (into_a.dot(wedge.side_b) < 0.0) into_a = -into_a;
  if (into_b.dot(wedge.side_a) < 0.0) into_b = -into_b;
  const auto bend = [&](const Vec3& side, const Vec3& inward, const Vec3& above_other) {
    return bend_of_side(wedge.at, wedge.along, side, inward, above_other, points, tolerance);
  };
  const double a = bend(wedge.side_a, into_a, into_b), b = bend(wedge.side_b, into_b, into_a);
  return 0.5 * (a + b);
}

}  // namespace pcednet::lines
