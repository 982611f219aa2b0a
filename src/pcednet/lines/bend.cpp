#include "pcednet/lines/bend.h"

#include <Eigen/Geometry>

#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/lanes.h"
#include "pcednet/lines/plane_wedge.h"

namespace pcednet::lines {
namespace {

/// Ends of the zones of a side: near the line, between, far; in spacings.
constexpr double kNearZone[] = {0.15, 0.9}, kMiddleZone = 1.9, kFarZone = 3.3;

/// Sums of heights over the points of a side that are near the line, beyond and far from it.
struct ZoneSums {
  double height[3], count[3];
};

PCEDNET_VECTOR_CLONES
ZoneSums sum_zones(const Vec3& at, const Vec3& along, const Vec3& side, const Vec3& inward,
                   const NearPoints& points, double most_height) {
  const double ends[4] = {kNearZone[0], kNearZone[1], kMiddleZone, kFarZone};
  const double at_x = at.x(), at_y = at.y(), at_z = at.z();
  const double along_x = along.x(), along_y = along.y(), along_z = along.z();
  const double side_x = side.x(), side_y = side.y(), side_z = side.z();
  const double up_x = inward.x(), up_y = inward.y(), up_z = inward.z();
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
    const auto is_near = (lengthwise <= kSliceAlong) & (lengthwise >= -kSliceAlong) &
                         (height <= most_height) & (height >= -most_height) & (number < count);
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
                    const NearPoints& points, double tolerance) {
  const ZoneSums sums = sum_zones(at, along, side, inward, points, tolerance + 0.3);
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
  const double a = bend_of_side(wedge.at, wedge.along, wedge.side_a, into_a, points, tolerance);
  const double b = bend_of_side(wedge.at, wedge.along, wedge.side_b, into_b, points, tolerance);
  return 0.5 * (a + b);
}

}  // namespace pcednet::lines
