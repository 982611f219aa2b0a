#include "pcednet/lines/creases/boundary.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/lines/creases/shadows.h"
#include "pcednet/lines/points/moments.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/spatial/opening.h"

namespace pcednet::lines {
namespace {

/// Where scan lines are much farther from each other than their points, the nearest are of one
/// line, which leaves both of its sides open: more have to tell.
constexpr std::size_t kNeighbours = 25, kMoreNeighbours = 100;
constexpr double kLine = 0.06;  ///< less across than along, as variances, is a line
constexpr double kOpenAngle = 125.0 * std::numbers::pi / 180.0;

// In spacings.
constexpr double kOffPlane = 0.8;
constexpr double kStrip = 1.0;       ///< half the width of the strip that ends at the boundary
constexpr double kBeyondLast = 0.4;  ///< from the last of its points to the boundary, on average

/// The principal axes of neighbours, that of the least variance first.
Eigendecomposition axes_of(const OrderedPoints& cloud, std::span<const spatial::Neighbour> points) {
  PointMoments moments;
  for (const auto& near : points) {
    moments.add(cloud.position(near.index) - cloud.position(points.front().index));
  }
  return eigendecomposition(moments.covariance());
}

bool are_in_line(const Eigendecomposition& axes) {
  return axes.values[1] < kLine * axes.values[2];
}

std::optional<Crease> boundary_at(const OrderedPoints& cloud, const Shadows& shadows, std::size_t i,
                                  const Vec3& normal, std::span<const spatial::Neighbour> nearest) {
  if (normal.isZero(0.0)) return std::nullopt;
  const double spacing = spacing_of(nearest);
  if (!(spacing > 0.0) || nearest.size() < kNeighbours / 2) return std::nullopt;
  const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<double> angles;
  for (const auto& near : nearest) {
    const Vec3 offset = cloud.position(near.index) - cloud.position(i);
    const Eigen::Vector2d flat(x.dot(offset), y.dot(offset));
    if (flat.norm() > 0.1 * spacing) angles.push_back(std::atan2(flat.y(), flat.x()));
  }
  if (angles.size() < kNeighbours / 3) return std::nullopt;
  const spatial::Opening opening = spatial::widest_opening(angles);
  if (opening.width < kOpenAngle) return std::nullopt;
  const Vec3 outward = std::cos(opening.middle) * x + std::sin(opening.middle) * y;
  if (spatial::goes_on_beyond(cloud, cloud.position(i), outward, normal, nearest,
                              [&](std::uint32_t j) -> const Vec3& { return cloud.position(j); })) {
    return std::nullopt;
  }
  if (shadows.are_why_it_ends(i, outward, spacing)) return std::nullopt;
  const Vec3 along = normal.cross(outward);
  double last = 0.0;
  for (const auto& near : nearest) {
    const Vec3 offset = (cloud.position(near.index) - cloud.position(i)) / spacing;
    if (std::abs(offset.dot(along)) > kStrip || std::abs(offset.dot(normal)) > kOffPlane) continue;
    last = std::max(last, offset.dot(outward));
  }
  return Crease{.at = cloud.position(i) + (last + kBeyondLast) * spacing * outward,
                .along = along,
                .side_a = -outward,
                .side_b = -outward,
                .spacing = spacing,
                .probability = static_cast<float>(std::min(1.0, opening.width / std::numbers::pi)),
                .edge_class = kBoundary};
}

}  // namespace

std::vector<Crease> find_boundaries(const OrderedPoints& cloud, const Progress* progress) {
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_partial(i)) points.push_back(i);
  }
  const Shadows shadows(cloud);
  Stage stage(progress, "boundaries", points.size());
  std::vector<Crease> boundaries;
  std::vector<std::uint8_t> in_line(cloud.size(), 0);
  append_found(creases_at(cloud, points, kNeighbours, stage,
                          [&](std::uint32_t point, std::span<const spatial::Neighbour> others) {
                            auto boundary =
                                boundary_at(cloud, shadows, point, cloud.normal(point), others);
                            in_line[point] = boundary && are_in_line(axes_of(cloud, others));
                            return in_line[point] ? std::nullopt : boundary;
                          }),
               boundaries);
  std::erase_if(points, [&](std::uint32_t point) { return !in_line[point]; });
  if (points.empty()) return boundaries;
  Stage again(progress, "scanlines", points.size());
  append_found(creases_at(cloud, points, kMoreNeighbours, again,
                          [&](std::uint32_t point, std::span<const spatial::Neighbour> others) {
                            // The point's normal is of the nearest, which do not determine it.
                            const Eigendecomposition axes = axes_of(cloud, others);
                            if (are_in_line(axes)) return std::optional<Crease>();
                            return boundary_at(cloud, shadows, point, axes.vectors.col(0), others);
                          }),
               boundaries);
  return boundaries;
}

}  // namespace pcednet::lines
