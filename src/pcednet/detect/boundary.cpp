#include "pcednet/detect/boundary.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/points/distinct_points.h"
#include "pcednet/detect/spread.h"
#include "pcednet/spatial/neighbour_search.h"
#include "pcednet/spatial/opening.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kNeighbours = kBoundaryNeighbours, kLeastNeighbours = 12;
constexpr std::size_t kTogether = 1024;

constexpr double kOpening = 105.0 * std::numbers::pi / 180.0;
constexpr double kWideOpening = 125.0 * std::numbers::pi / 180.0;
constexpr double kOffCentre = 0.2;     ///< of the neighbours' centre, in their radius
constexpr double kAcrossFrom = 0.92;   ///< cosine to the direction away from that centre
constexpr double kLeastSpread = 0.06;  ///< less across than along, as variances, is a line

// In spacings.
constexpr double kThickness = 1.0;  ///< standard deviation of the neighbours from their plane
constexpr double kHeight = 1.0;     ///< of the point above it
constexpr double kClear = 0.5;      ///< the most of both where no noise hides what else is there
constexpr double kExact = 0.1;      ///< nearer points are never outliers

constexpr double kOutlier = 3.0;    ///< median distances from the plane
constexpr double kInliers = 0.7;    ///< share of the neighbours
constexpr double kAgreement = 0.8;  ///< mean cosine between the neighbours' normals and the plane's
constexpr double kOpposed = 0.2;    ///< share of neighbours that face the other way

// For the neighbours that a rim point needs along the rim; lengths in spacings.
constexpr double kSameSide = 0.5;  ///< cosine between the open directions
constexpr double kLeastAlong = 0.3;
constexpr double kAcross = 0.7;  ///< and as much per length along the rim

constexpr std::uint32_t kNone = 0xffffffff;

/// A point with all its neighbours on one side.
struct RimPoint {
  std::uint32_t point = kNone;
  Vec3 outward = Vec3::Zero(), along = Vec3::Zero();  ///< unit, orthogonal
  double spacing = 0.0;
  bool wide = false;  ///< the opening is kWideOpening or more
  bool clear = false;
  std::array<std::uint32_t, kNeighbours> others;
};

/// Neighbours as seen from a point.
struct Around {
  std::array<Vec3, kNeighbours> offset;
  std::array<std::uint32_t, kNeighbours> index;
  std::size_t count = 0;

  void add(const Vec3& its_offset, std::uint32_t its_index) {
    offset[count] = its_offset;
    index[count++] = its_index;
  }
  Vec3 sum() const {
    Vec3 total = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) total += offset[i];
    return total;
  }
};

/// The plane of the neighbours and the point.
struct Plane {
  Vec3 centre, normal, x, y;
  double thickness;  ///< standard deviation along the normal
  double spread;     ///< the smaller variance within the plane over the larger

  double height(const Vec3& offset) const { return std::abs(normal.dot(offset - centre)); }
};

Plane plane_of(const Around& around) {
  const double count = static_cast<double>(around.count + 1);
  const Vec3 centre = around.sum() / count;
  Mat3 covariance = centre * centre.transpose();
  for (std::size_t i = 0; i < around.count; ++i) {
    const Vec3 offset = around.offset[i] - centre;
    covariance += offset * offset.transpose();
  }
  const auto [variances, axes] = eigendecomposition(covariance / count);
  const Vec3 normal = axes.col(0), y = axes.col(1);
  return {.centre = centre,
          .normal = normal,
          .x = y.cross(normal),
          .y = y,
          .thickness = std::sqrt(std::max(0.0, variances[0])),
          .spread = variances[2] > 0.0 ? variances[1] / variances[2] : 0.0};
}

/// The neighbours not far off the plane.
Around inliers(const Around& around, const Plane& plane, double spacing) {
  std::array<double, kNeighbours> heights = {};
  for (std::size_t i = 0; i < around.count; ++i) heights[i] = plane.height(around.offset[i]);
  std::array<double, kNeighbours> sorted = heights;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(around.count / 2);
  std::nth_element(sorted.begin(), middle,
                   sorted.begin() + static_cast<std::ptrdiff_t>(around.count));
  const double most = std::max(kOutlier * *middle, kExact * spacing);
  Around kept;
  for (std::size_t i = 0; i < around.count; ++i) {
    if (heights[i] <= most) kept.add(around.offset[i], around.index[i]);
  }
  return kept;
}

/// Whether the normals of the neighbours are those of one sheet in the plane.
bool is_one_sheet(const DistinctPoints& points, const Around& around, const Vec3& normal) {
  double sum = 0.0, known = 0.0, up = 0.0, down = 0.0;
  for (std::size_t i = 0; i < around.count; ++i) {
    const Vec3 other = points.normal(around.index[i]);
    if (other.isZero(0.0)) continue;
    const double cosine = other.dot(normal);
    known += 1.0;
    sum += std::abs(cosine);
    up += cosine > 0.0 ? 1.0 : 0.0;
    down += cosine < 0.0 ? 1.0 : 0.0;
  }
  return known == 0.0 || (sum > kAgreement * known && std::min(up, down) <= kOpposed * known);
}

/// Whether the neighbours may leave an opening: their centre is off the point, and none is straight
/// across from it. Decides for most points.
bool may_open(const DistinctPoints& points, std::uint32_t point,
              std::span<const spatial::Neighbour> others) {
  const Vec3& position = points.positions[point];
  Vec3 sum = Vec3::Zero();
  for (const spatial::Neighbour& other : others) sum += points.positions[other.index] - position;
  const double length = sum.norm();
  const double count = static_cast<double>(others.size());
  if (length < kOffCentre * std::sqrt(others.back().sq_distance) * count) return false;
  const Vec3 outward = -sum / length;
  return std::none_of(others.begin(), others.end(), [&](const spatial::Neighbour& other) {
    const double along = outward.dot(points.positions[other.index] - position);
    return along > 0.0 && along * along > kAcrossFrom * kAcrossFrom * other.sq_distance;
  });
}

std::optional<RimPoint> rim_at(const DistinctPoints& points, const spatial::NeighbourSearch& search,
                               std::uint32_t point, std::span<const spatial::Neighbour> others) {
  if (!may_open(points, point, others)) return std::nullopt;
  Around all;
  for (const spatial::Neighbour& other : others) {
    all.add(points.positions[other.index] - points.positions[point], other.index);
  }
  const double count = static_cast<double>(all.count);
  const double radius = std::sqrt(others.back().sq_distance);
  const double spacing = radius * std::sqrt(0.5 * std::numbers::pi / count);  // in half a disc

  const Around around = inliers(all, plane_of(all), spacing);
  if (static_cast<double>(around.count) < kInliers * count) return std::nullopt;
  const Plane plane = plane_of(around);
  const double height = plane.height(Vec3::Zero());
  if (plane.thickness > kThickness * spacing || height > kHeight * spacing ||
      plane.spread < kLeastSpread || !is_one_sheet(points, all, plane.normal)) {
    return std::nullopt;
  }
  std::array<double, kNeighbours> angles;
  for (std::size_t i = 0; i < all.count; ++i) {
    angles[i] = std::atan2(plane.y.dot(all.offset[i]), plane.x.dot(all.offset[i]));
  }
  const auto opening = spatial::widest_opening(std::span(angles).first(all.count));
  if (opening.width < kOpening) return std::nullopt;
  const Vec3 outward = std::cos(opening.middle) * plane.x + std::sin(opening.middle) * plane.y;
  const double inside = -around.sum().dot(outward) / static_cast<double>(around.count);
  if (inside < kOffCentre * radius) return std::nullopt;
  if (spatial::goes_on_beyond(
          search, points.positions[point], outward, plane.normal, others,
          [&](std::uint32_t i) -> const Vec3& { return points.positions[i]; })) {
    return std::nullopt;
  }

  RimPoint rim{.point = point,
               .outward = outward,
               .along = plane.normal.cross(outward),
               .spacing = spacing,
               .wide = opening.width >= kWideOpening,
               .clear = std::max(plane.thickness, height) <= kClear * spacing,
               .others = all.index};
  std::fill(rim.others.begin() + static_cast<std::ptrdiff_t>(all.count), rim.others.end(), kNone);
  return rim;
}

/// The points of all rims, and of gaps that look like one.
std::vector<RimPoint> find_rims(const DistinctPoints& points, const Progress* progress) {
  const spatial::NeighbourSearch search(points.positions);
  if (search.available(kNeighbours) < kLeastNeighbours) return {};
  std::vector<RimPoint> rims;
  Stage stage(progress, "boundary", points.size());
  const auto try_places = [&](std::span<const std::uint32_t> todo) {
    const auto found = found_at<RimPoint>(search, todo, kNeighbours, stage,
                                          [&](std::uint32_t point, const auto& others) {
                                            return rim_at(points, search, point, others);
                                          });
    rims.insert(rims.end(), found.begin(), found.end());
    std::vector<std::uint32_t> around;
    for (const RimPoint& rim : found) {
      std::copy_if(rim.others.begin(), rim.others.end(), std::back_inserter(around),
                   [](std::uint32_t other) { return other != kNone; });
    }
    return around;
  };
  const auto first = first_places(points.positions, points.cloud.part);
  stage.advance(points.size() - spread(points.size(), first, try_places));
  return rims;
}

/// Whether the rim continues to both sides of the point, through the rims numbered `rim_of` the
/// points, one of which opens widely.
bool goes_on(const RimPoint& rim, const DistinctPoints& points, std::span<const RimPoint> rims,
             std::span<const std::uint32_t> rim_of) {
  bool before = false, after = false, wide = rim.wide;
  for (const std::uint32_t point : rim.others) {
    if (point == kNone || rim_of[point] == kNone) continue;
    const RimPoint& other = rims[rim_of[point]];
    if (other.outward.dot(rim.outward) < kSameSide) continue;
    const Vec3 offset = (points.positions[point] - points.positions[rim.point]) / rim.spacing;
    const double along = offset.dot(rim.along), across = std::abs(offset.dot(rim.outward));
    if (across > kAcross * (1.0 + std::abs(along))) continue;
    wide = wide || other.wide;
    before = before || along < -kLeastAlong;
    after = after || along > kLeastAlong;
  }
  return wide && before && after;
}

/// Removes points whose rim does not continue, and the ends that this leaves.
void remove_isolated(const DistinctPoints& points, std::vector<RimPoint>& rims) {
  std::vector<std::uint32_t> rim_of(points.size(), kNone);
  for (int round = 0; round < kBoundaryRounds; ++round) {
    for (std::size_t i = 0; i < rims.size(); ++i) {
      rim_of[rims[i].point] = static_cast<std::uint32_t>(i);
    }
    std::vector<std::uint8_t> stays(rims.size(), 0);
    parallel_blocks(rims.size(), kTogether, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) stays[i] = goes_on(rims[i], points, rims, rim_of);
    });
    for (const RimPoint& rim : rims) rim_of[rim.point] = kNone;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rims.size(); ++i) {
      if (stays[i]) rims[kept++] = rims[i];
    }
    rims.resize(kept);
  }
}

}  // namespace

std::vector<BoundaryPoint> find_boundary(const PreparedCloud& cloud, const Progress* progress) {
  check_consistent(cloud);
  const DistinctPoints points(cloud);
  std::vector<RimPoint> rims = find_rims(points, progress);
  remove_isolated(points, rims);
  std::vector<BoundaryPoint> boundary;
  for (const RimPoint& rim : rims) {
    for (const std::uint32_t copy : points.points(rim.point)) boundary.push_back({copy, rim.clear});
  }
  std::sort(boundary.begin(), boundary.end(),
            [](const BoundaryPoint& a, const BoundaryPoint& b) { return a.point < b.point; });
  return boundary;
}

void mark_boundary(std::span<const BoundaryPoint> boundary, std::span<std::uint8_t> classes) {
  for (const BoundaryPoint& found : boundary) {
    std::uint8_t& its = classes[found.point];
    const bool is_edge = its == kSharpEdge || its == kSmoothEdge;
    if ((is_edge && found.clear) || its == kNonEdge || its == kUnlabelled) its = kBoundary;
  }
}

void mark_boundary(const PreparedCloud& cloud, Classification& found, const Progress* progress) {
  check_size(found, cloud.positions.size());
  mark_boundary(find_boundary(cloud, progress), found.classes);
  found.counts = count_classes(found.classes);
}

}  // namespace pcednet::detect
