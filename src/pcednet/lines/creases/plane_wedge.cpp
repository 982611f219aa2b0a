#include "pcednet/lines/creases/plane_wedge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/points/plane_line.h"
#include "pcednet/lines/points/sampling.h"

namespace pcednet::lines {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLeastAngle = 20.0 * kDegree;
/// Strips of a rounded surface that are nearly flat meet at less.
constexpr double kLeastAngleOfExact = 35.0 * kDegree;

constexpr double kFlatShare = 0.6;  ///< share of the points near a plane that are on it

// In spacings.
constexpr double kFarthest = 2.2;         ///< of a point from its crease
constexpr double kLeastFromLine = 0.4;    ///< of those that tell on which side the surface is
constexpr double kExact[] = {0.08, 0.2};  ///< exactly, or nearly so, where edges are curved
constexpr double kNearPlane = 0.3;
constexpr double kOnSurface = 1.0;  ///< from the line of such planes to the first points

/// What two planes must show, in spacings.
struct PairTests {
  double plane;  ///< from a plane to its points, at most
  double first;  ///< from the line to the nearest points of a side, at most
  double least_angle;
};

/// The points of a plane near its line.
struct SideCounts {
  int before = 0, after = 0;  ///< on the two sides of the line
  int first = 0;              ///< of these, near enough to it
};

PCEDNET_VECTOR_CLONES
SideCounts count_sides(const LocalPlane& plane, const Vec3& at, const Vec3& along, const Vec3& side,
                       const NearPoints& points, const PairTests& tests) {
  const double at_x = at.x(), at_y = at.y(), at_z = at.z();
  const double along_x = along.x(), along_y = along.y(), along_z = along.z();
  const double side_x = side.x(), side_y = side.y(), side_z = side.z();
  const double a = plane.normal.x(), b = plane.normal.y(), c = plane.normal.z();
  const double distance = plane.distance, most_height = tests.plane, first = tests.first;
  const double least = larger(kLeastFromLine, 1.5 * tests.plane);
  SideCounts counts;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double x = points.x[i] - at_x, y = points.y[i] - at_y, z = points.z[i] - at_z;
    const double lengthwise = std::fabs(x * along_x + y * along_y + z * along_z);
    const double height = std::fabs(a * points.x[i] + b * points.y[i] + c * points.z[i] - distance);
    const double place = x * side_x + y * side_y + z * side_z, away = std::fabs(place);
    const bool counts_here = (lengthwise <= kSliceAlong) & (height <= most_height) &
                             (away >= least) & (away <= kSideReach);
    counts.before += static_cast<int>(counts_here & (place < 0.0));
    counts.after += static_cast<int>(counts_here & (place >= 0.0));
    counts.first += static_cast<int>(counts_here & (away <= first));
  }
  return counts;
}

/// The direction from the line into `plane` on which its points are near the line's point `at`, or
/// none if they are on both sides, too few, or all far from it.
std::optional<Vec3> side_of(const LocalPlane& plane, const Vec3& at, const Vec3& along,
                            const NearPoints& points, const PairTests& tests) {
  const Vec3 side = along.cross(plane.normal).normalized();
  const SideCounts counts = count_sides(plane, at, along, side, points, tests);
  const auto [fewer, more] = std::minmax(counts.before, counts.after);
  if (more < 2 || counts.first == 0 || 4 * fewer > more) return std::nullopt;
  return counts.before > counts.after ? Vec3(-side) : side;
}

std::optional<Wedge> wedge_of(const LocalPlane& a, const LocalPlane& b, const NearPoints& points,
                              const PairTests& tests) {
  const auto line =
      line_of_planes(a.normal, a.distance, b.normal, b.distance, std::sin(tests.least_angle));
  if (!line || line->point.norm() > kFarthest) return std::nullopt;
  const auto side_a = side_of(a, line->point, line->along, points, tests);
  const auto side_b = side_of(b, line->point, line->along, points, tests);
  if (!side_a || !side_b) return std::nullopt;
  return Wedge{line->point, line->along, *side_a, *side_b};
}

/// Large for planes that meet at right angles in the point.
double score_of(const Wedge& wedge) {
  return wedge.side_a.cross(wedge.side_b).norm() - 0.5 * wedge.at.norm();
}

std::optional<Wedge> best_of_pairs(const std::vector<LocalPlane>& planes, const NearPoints& points,
                                   const PairTests& tests) {
  std::optional<Wedge> best;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      const auto wedge = wedge_of(planes[a], planes[b], points, tests);
      if (wedge && (!best || score_of(*wedge) > score_of(*best))) best = wedge;
    }
  }
  return best;
}

/// Whether most points near the plane are on it: it is no tangent of a rounded surface.
bool is_flat(const LocalPlane& plane, const NearPoints& points, double tolerance) {
  double near = 0.0, on = 0.0;
  for (std::size_t i = 0; i < points.count; ++i) {
    if (std::abs(plane.normal.dot(points.normal(i))) < kSameNormal) continue;
    const double away = std::abs(plane.height(points.offset(i)));
    near += away < kNearPlane ? 1.0 : 0.0;
    on += away < tolerance ? 1.0 : 0.0;
  }
  return on > kFlatShare * near;
}

}  // namespace

std::optional<Wedge> best_plane_wedge(const NearPoints& points, const WedgeTolerances& within) {
  std::vector<LocalPlane> planes;
  if (within.noise < kExactNoise) {
    for (const double exact : kExact) {
      const double tolerance = exact + within.noise;
      find_planes(points, tolerance, planes);
      std::erase_if(planes, [&](const auto& plane) { return !is_flat(plane, points, tolerance); });
      auto wedge = best_of_pairs(planes, points, {tolerance, kOnSurface, kLeastAngleOfExact});
      if (wedge) return wedge;
    }
  }
  find_planes(points, within.plane, planes);
  return best_of_pairs(planes, points, {within.plane, within.first, kLeastAngle});
}

}  // namespace pcednet::lines
