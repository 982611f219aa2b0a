#include "pcednet/lines/pieces/smooth_joints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "pcednet/lines/curves/fit.h"
#include "pcednet/lines/curves/touch.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/pieces/strings.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostRound = 3;  ///< curves round a circle: four are the sides of a rectangle
constexpr double kLargestRound = 8.0;  ///< radius of such a circle, in spacings

/// End `end` is that of curve end / 2: its first point, or its last.
const Vec3& place_of(const std::vector<Curve>& curves, std::size_t end) {
  const Curve& curve = curves[end / 2];
  return end % 2 == 0 ? curve.points.front() : curve.points.back();
}

/// The direction in which the curve would go on beyond an end.
Vec3 outward(const std::vector<Curve>& curves, std::size_t end) {
  const Curve& curve = curves[end / 2];
  const bool first = end % 2 == 0;
  if (curve.kind == CurveKind::kArc) {
    const Vec3 on = curve.axis.cross(place_of(curves, end) - curve.centre).normalized();
    return first ? Vec3(-on) : on;
  }
  const std::size_t last = curve.points.size() - 1;
  const Vec3& before = curve.points[first ? 1 : last - 1];
  return (place_of(curves, end) - before).stableNormalized();
}

bool is_exact_arc(const Curve& curve) {
  return curve.exact && curve.kind == CurveKind::kArc;
}

bool are_one(const std::vector<Curve>& curves, std::size_t a, std::size_t b, double cosine) {
  const Curve &of_a = curves[a / 2], &of_b = curves[b / 2];
  if (of_a.edge_class != of_b.edge_class) return false;
  if (is_exact_arc(of_a) || is_exact_arc(of_b)) return false;
  const double along = -outward(curves, a).dot(outward(curves, b));
  const bool polyline = of_a.kind == CurveKind::kPolyline || of_b.kind == CurveKind::kPolyline;
  const bool touching = of_a.kind != of_b.kind && (polyline || along > kTouching);
  return along > cosine && !touching;
}

/// For each end, the end that it alone meets, if `together` says so of the two.
template <typename Together>
std::vector<std::size_t> partners_of(const std::vector<Curve>& curves, const Together& together) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!curves[i].closed) ends.insert(ends.end(), {2 * i, 2 * i + 1});
  }
  const auto compare = [&](std::size_t a, std::size_t b) {
    return is_before(place_of(curves, a), place_of(curves, b));
  };
  std::stable_sort(ends.begin(), ends.end(), compare);
  std::vector<std::size_t> partner(2 * curves.size(), kNoPartner);
  for (std::size_t first = 0, next; first < ends.size(); first = next) {
    next = first + 1;
    while (next < ends.size() && !compare(ends[first], ends[next])) ++next;
    if (next - first != 2) continue;
    const std::size_t a = ends[first], b = ends[first + 1];
    if (a / 2 == b / 2 || !together(a, b)) continue;
    partner[a] = b;
    partner[b] = a;
  }
  return partner;
}

/// Gives `whole` the class and the means of the curves that it is made of: of their dihedral angles
/// by length, of their confidences by edge points, or by length if there are none.
void take_attributes(Curve& whole, std::span<const Curve* const> parts) {
  double length = 0.0, by_support = 0.0, by_length = 0.0;
  whole.edge_class = parts.front()->edge_class;
  whole.exact = true;
  for (const Curve* part : parts) {
    const double its_length = length_of(*part);
    length += its_length;
    by_length += its_length * part->confidence;
    by_support += static_cast<double>(part->support) * part->confidence;
    whole.dihedral_angle += its_length * part->dihedral_angle;
    whole.support += part->support;
    whole.exact &= part->exact;
  }
  whole.dihedral_angle /= length;
  whole.confidence =
      whole.support > 0 ? by_support / static_cast<double>(whole.support) : by_length / length;
}

/// The polyline with points no further apart than `step`.
std::vector<Vec3> densified(const std::vector<Vec3>& points, double step) {
  std::vector<Vec3> dense;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 side = points[i + 1] - points[i];
    const int parts = static_cast<int>(std::clamp(side.norm() / step, 0.0, 1e4)) + 1;
    for (int k = 0; k < parts; ++k)
      dense.push_back(points[i] + (k / static_cast<double>(parts)) * side);
  }
  return dense;
}

/// Adds `next`, entered at `entry`, to `whole`, which ends there.
void append(Curve& whole, const Curve& next, std::size_t entry, double tolerance) {
  std::vector<Vec3> points = sampled(next, tolerance);
  if (entry % 2 == 1) std::reverse(points.begin(), points.end());
  const std::size_t shared = whole.points.empty() ? 0 : 1;
  whole.points.insert(whole.points.end(), points.begin() + static_cast<std::ptrdiff_t>(shared),
                      points.end());
}

/// The curves of the loop that begins with `first`, if it is one of so few.
std::vector<std::size_t> loop_of(std::size_t first, const std::vector<std::size_t>& partner) {
  std::vector<std::size_t> loop;
  std::size_t entry = 2 * first;
  do {
    loop.push_back(entry / 2);
    entry = partner[entry ^ 1U];
    if (entry == kNoPartner || loop.size() > kMostRound) return {};
  } while (entry / 2 != first);
  return loop.size() < 2 ? std::vector<std::size_t>() : loop;
}

/// The circle that the curves of a loop are near to.
std::optional<Curve> circle_of(const std::vector<std::size_t>& loop,
                               const std::vector<Curve>& curves, double spacing, double within) {
  std::vector<Vec3> places;
  std::vector<const Curve*> parts;
  for (const std::size_t i : loop) {
    const std::vector<Vec3> dense = densified(sampled(curves[i], 0.1 * within), 0.5 * spacing);
    places.insert(places.end(), dense.begin(), dense.end());
    parts.push_back(&curves[i]);
  }
  Curve circle{.kind = CurveKind::kCircle, .closed = true};
  take_attributes(circle, parts);
  if (circle.exact) return std::nullopt;  // it has corners
  const Fit fit = fit_arc(places, spacing);
  if (fit.kind != CurveKind::kArc || fit.radius > kLargestRound * spacing) return std::nullopt;
  for (const Vec3& place : places) {
    if (!((nearest_on(fit, place) - place).norm() < within)) return std::nullopt;
  }
  circle.centre = fit.point;
  circle.axis = fit.direction;
  circle.radius = fit.radius;
  circle.points = {nearest_on(fit, places.front())};
  return circle;
}

/// Makes a segment of an open polyline whose vertices are within the tolerance of its class from
/// the chord; of exact surfaces, if it has no other vertices.
void straighten(Curve& curve, double tolerance, double spacing) {
  if (curve.kind != CurveKind::kPolyline || curve.closed) return;
  if (curve.edge_class == kBoundary) tolerance = std::max(tolerance, kBoundaryTolerance);
  const double within = curve.exact ? 0.0 : tolerance * spacing;
  if (simplified(curve.points, within).size() != 2) return;
  curve.points = {curve.points.front(), curve.points.back()};
  curve.kind = CurveKind::kSegment;
}

}  // namespace

void close_round_loops(std::vector<Curve>& curves, double spacing, double within) {
  const std::vector<std::size_t> partner = partners_of(curves, [&](std::size_t a, std::size_t b) {
    return curves[a / 2].edge_class == curves[b / 2].edge_class;
  });
  std::vector<std::uint8_t> gone(curves.size(), 0);
  std::vector<Curve> circles;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (gone[i] || curves[i].closed) continue;
    const std::vector<std::size_t> loop = loop_of(i, partner);
    if (loop.empty()) continue;
    auto circle = circle_of(loop, curves, spacing, within);
    if (!circle) continue;
    for (const std::size_t j : loop) gone[j] = 1;
    circles.push_back(std::move(*circle));
  }
  std::size_t i = 0;
  std::erase_if(curves, [&](const Curve&) { return gone[i++] != 0; });
  curves.insert(curves.end(), circles.begin(), circles.end());
}

void join_smooth_corners(std::vector<Curve>& curves, double angle, double tolerance,
                         double spacing) {
  for (Curve& curve : curves) straighten(curve, tolerance, spacing);
  const double cosine = std::cos(angle), within = 0.5 * tolerance * spacing;
  const std::vector<std::size_t> partner = partners_of(
      curves, [&](std::size_t a, std::size_t b) { return are_one(curves, a, b, cosine); });
  std::vector<Curve> result;
  for (const auto& [entries, closed] : follow_partners(partner)) {
    if (entries.size() == 1) {
      result.push_back(std::move(curves[entries[0] / 2]));
      continue;
    }
    Curve whole{.closed = closed};
    std::vector<const Curve*> parts;
    for (const std::size_t entry : entries) {
      append(whole, curves[entry / 2], entry, within);
      parts.push_back(&curves[entry / 2]);
    }
    take_attributes(whole, parts);
    whole.points = simplified(whole.points, within);
    if (closed) whole.points.pop_back();
    result.push_back(std::move(whole));
  }
  for (Curve& curve : result) straighten(curve, tolerance, spacing);
  curves = std::move(result);
}

}  // namespace pcednet::lines
