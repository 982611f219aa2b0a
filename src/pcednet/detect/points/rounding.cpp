#include "pcednet/detect/points/rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/coordinate_step.h"
#include "pcednet/core/median.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/core/random.h"
#include "pcednet/detect/points/exact_points.h"
#include "pcednet/detect/points/near_on_curve.h"
#include "pcednet/gls/scales.h"
#include "pcednet/normals/plane_fit.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

constexpr double kLeastStep = 0.1;       ///< that matters, over the spacing
constexpr std::size_t kShareMoved = 20;  ///< one point in so many lies on a surface that was moved

/// The median over the points. A circle about a point with `kInCircle` others in it has as many
/// times the area that a point takes; further ones are often elsewhere on the curve.
double spacing_of(std::span<const Vec3> positions, const NearOnCurve& near) {
  constexpr std::size_t kInCircle = 4;
  std::vector<double> reach(near.points.size());
  for (std::size_t i = 0; i < reach.size(); ++i) {
    reach[i] = (positions[near.of(i)[kInCircle - 1]] - positions[near.points[i]]).norm();
  }
  return upper_median(reach) * std::sqrt(std::numbers::pi / kInCircle);
}

/// Whether fewer than half of the points near one have a coordinate in common with it, as on faces
/// parallel to an axis, and they lie on no other plane either.
bool is_moved(std::span<const Vec3> positions, std::uint32_t point,
              std::span<const std::uint32_t> near, const normals::PlaneFit& fit, double step) {
  if (fit.thickness < kExactThickness) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto common = std::count_if(near.begin(), near.end(), [&](std::uint32_t other) {
      return std::abs(positions[other][axis] - positions[point][axis]) < 0.5 * step;
    });
    if (2 * static_cast<std::size_t>(common) >= near.size()) return false;
  }
  return true;
}

}  // namespace

Rounding find_rounding(std::span<const Vec3> positions, std::span<const std::uint32_t> curve) {
  const NearOnCurve near = near_on_curve(positions, curve);
  if (near.points.empty()) return {};
  const double step = coordinate_step(positions, near.points);
  const double spacing = spacing_of(positions, near);
  if (step < kLeastStep * spacing || step == 0.0) return {};
  std::vector<normals::PlaneFit> fits(near.points.size());
  normals::fit_planes(positions, near.points, near.neighbours, fits);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    moved += is_moved(positions, near.points[i], near.of(i), fits[i], step) ? 1 : 0;
  }
  if (moved * kShareMoved < fits.size()) return {};
  return {step, bounding_box(positions).min, spacing};
}

std::vector<Vec3> spread(std::span<const Vec3> positions, const Rounding& rounding) {
  std::vector<Vec3> moved(positions.begin(), positions.end());
  parallel_for_each(moved.size(), [&](std::size_t i) {
    Vec3& position = moved[i];
    if (!position.allFinite()) return;
    const auto multiple = [&](int axis) {
      return static_cast<std::uint64_t>(
          std::llround((position[axis] - rounding.origin[axis]) / rounding.step));
    };
    Random random(multiple(0), Random(multiple(1), multiple(2)).next());
    for (double& coordinate : position) coordinate += rounding.step * random.uniform(-0.5, 0.5);
  });
  return moved;
}

bool may_be_too_coarse(ScalarType type, const NormalsDecision& decision,
                       const gls::ScaleRange& range) {
  return type == ScalarType::kFloat32 && range.s_min == 0.0 && decision.rounding.step == 0.0;
}

double share_of_places(std::span<const Vec3> positions, std::span<const std::uint32_t> curve) {
  if (curve.empty()) return 1.0;
  return static_cast<double>(spatial::firsts_of_places(positions, curve).size()) /
         static_cast<double>(curve.size());
}

std::string note_on(const Rounding& rounding) {
  return fmt::format(
      "coordinates are rounded to {:.6g}, about {:.2g} of the spacing: points are spread "
      "within such a step before they are described, and written as they were read",
      rounding.step, rounding.step / rounding.spacing);
}

double smallest_scale(const PreparedCloud& cloud, const gls::ScaleRange& range) {
  const auto spacings = [&] { return gls::spacings_of_places(cloud.positions, cloud.curve); };
  return gls::scale_range(cloud.positions, range, spacings).s_min;
}

}  // namespace pcednet::detect
