#include "pcednet/lines/roofs/rectangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace pcednet::lines {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec2s = std::span<const Vec2>;

constexpr double kNumberPrice = 0.5 * kLinePrice;  ///< a line has two, a rectangle five
constexpr std::size_t kLargestOutline = 400;
constexpr double kDeepest = 2.0;             ///< spacings from a side to the outline
constexpr int kStepsAside = 12;              ///< from the best direction,
constexpr double kSteps[] = {0.065, 0.006};  ///< radians
constexpr double kLeastSide = 3.0;  ///< spacings: more than what is left open between two points

/// In its own coordinates.
struct EmptyBox {
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();

  double area() const { return (high - low).prod(); }
};

struct Polygon {
  double area = 0.0;  ///< negative if the outline is that of an opening
  Vec2 middle = Vec2::Zero();
};

Polygon polygon_of(Vec2s outline) {
  Polygon polygon;
  const Vec2& origin = outline.front();
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const Vec2 a = outline[i] - origin, b = outline[i + 1] - origin;
    const double twice = a.x() * b.y() - a.y() * b.x();
    polygon.area += 0.5 * twice;
    polygon.middle += twice * (a + b) / 6.0;
  }
  if (polygon.area != 0.0) polygon.middle = origin + polygon.middle / polygon.area;
  return polygon;
}

/// How far a box may reach to both sides of the middle if it ends at this height.
struct SideReach {
  double height, left, right;
};

/// For each end above the middle, or below it, from the nearest on.
std::vector<SideReach> reaches(Vec2s points, double up) {
  std::vector<Vec2> beyond;
  for (const Vec2& point : points) {
    if (up * point.y() >= 0.0) beyond.emplace_back(point.x(), up * point.y());
  }
  std::sort(beyond.begin(), beyond.end(), [](const Vec2& a, const Vec2& b) {
    return std::pair(a.y(), a.x()) < std::pair(b.y(), b.x());
  });
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<SideReach> found;
  double left = -kFar, right = kFar;
  for (const Vec2& point : beyond) {
    found.push_back({up * point.y(), left, right});
    double& side = point.x() < 0.0 ? left : right;
    side = point.x() < 0.0 ? std::max(side, point.x()) : std::min(side, point.x());
  }
  return found;
}

/// The largest box about the origin without a point in it.
EmptyBox largest_empty_box(Vec2s points) {
  EmptyBox best;
  const std::vector<SideReach> above = reaches(points, 1.0), below = reaches(points, -1.0);
  for (const SideReach& top : above) {
    for (const SideReach& bottom : below) {
      const EmptyBox box = {{std::max(top.left, bottom.left), bottom.height},
                            {std::min(top.right, bottom.right), top.height}};
      if (std::isfinite(box.area()) && box.area() > best.area()) best = box;
    }
  }
  return best;
}

/// The coordinates of a rectangle's direction.
struct Directed {
  Vec2 origin = Vec2::Zero(), along = Vec2::UnitX();

  Vec2 local(const Vec2& point) const {
    const Vec2 offset = point - origin;
    return {along.dot(offset), along.x() * offset.y() - along.y() * offset.x()};
  }
  Vec2 turned(const Vec2& vector) const {
    return {along.x() * vector.x() - along.y() * vector.y(),
            along.y() * vector.x() + along.x() * vector.y()};
  }
};

constexpr std::size_t kNoSide = 4;

/// Beside which side a point is; they follow each other as in the outline of an opening: left,
/// upper, right, lower.
std::size_t side_of(const Vec2& point, const EmptyBox& box) {
  const bool beside = point.y() >= box.low.y() && point.y() <= box.high.y();
  const bool over = point.x() >= box.low.x() && point.x() <= box.high.x();
  if (beside && point.x() <= box.low.x()) return 0;
  if (over && point.y() >= box.high.y()) return 1;
  if (beside && point.x() >= box.high.x()) return 2;
  if (over && point.y() <= box.low.y()) return 3;
  return kNoSide;
}

/// How far a point is from the rectangle, beside one of its sides.
double depth_of(const Vec2& point, const EmptyBox& box) {
  return (box.low - point).cwiseMax(point - box.high).maxCoeff();
}

/// Turns a loop so that it begins with the first point beside the first side.
bool begin_with_first_side(std::vector<Vec2>& outline, std::vector<std::size_t>& sides) {
  const std::size_t count = outline.size() - 1;
  for (std::size_t start = 0; start < count; ++start) {
    std::size_t before = start;
    do before = (before + count - 1) % count;
    while (sides[before] == kNoSide && before != start);
    if (sides[start] != 0 || sides[before] != 3) continue;
    const auto by = static_cast<std::ptrdiff_t>(start);
    outline.pop_back(), sides.pop_back();
    std::rotate(outline.begin(), outline.begin() + by, outline.end());
    std::rotate(sides.begin(), sides.begin() + by, sides.end());
    outline.push_back(outline.front()), sides.push_back(kNoSide);
    return true;
  }
  return false;
}

/// The sides with their points, which must follow each other.
std::optional<std::vector<SupportLine>> sides_of(std::vector<Vec2>& outline, const Directed& frame,
                                                 const EmptyBox& box, double spacing) {
  std::vector<std::size_t> sides;
  for (const Vec2& point : outline) sides.push_back(side_of(frame.local(point), box));
  if (!begin_with_first_side(outline, sides)) return std::nullopt;
  const std::array<Vec2, 5> corners = {box.low, Vec2(box.low.x(), box.high.y()), box.high,
                                       Vec2(box.high.x(), box.low.y()), box.low};
  std::vector<SupportLine> lines;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i] == kNoSide) continue;
    if (depth_of(frame.local(outline[i]), box) > kDeepest * spacing) return std::nullopt;
    if (sides[i] + 1 == lines.size()) {
      lines.back().last = i;
    } else if (sides[i] == lines.size()) {
      const Vec2 along = frame.turned((corners[sides[i] + 1] - corners[sides[i]]).normalized());
      const Vec2 normal(along.y(), -along.x());
      const Vec2 corner = frame.origin + frame.turned(corners[sides[i]]);
      lines.push_back({.first = i, .last = i, .normal = normal, .offset = normal.dot(corner)});
    } else {
      return std::nullopt;
    }
  }
  if (lines.size() != 4) return std::nullopt;
  for (std::size_t k = 0; k < 4; ++k) {
    SupportLine& line = lines[k];
    const Vec2 from = frame.origin + frame.turned(corners[k]);
    const Vec2 to = frame.origin + frame.turned(corners[k + 1]);
    line.to_corner[0] = line.along().dot(outline[line.first] - from);
    line.to_corner[1] = line.along().dot(to - outline[line.last]);
    if (line.first == line.last) return std::nullopt;
  }
  return lines;
}

}  // namespace

std::optional<std::vector<SupportLine>> rectangular_opening(std::vector<Vec2>& outline, double cost,
                                                            Vec2s directions, double spacing) {
  if (outline.size() > kLargestOutline) return std::nullopt;
  const Polygon polygon = polygon_of(outline);
  if (!(polygon.area < 0.0)) return std::nullopt;
  Directed best_frame;
  EmptyBox best;
  const auto try_direction = [&](const Vec2& direction, double price) {
    const Directed frame = {polygon.middle, direction};
    std::vector<Vec2> points;
    for (const Vec2& point : outline) points.push_back(frame.local(point));
    const EmptyBox box = largest_empty_box(points);
    if ((box.high - box.low).minCoeff() < kLeastSide * spacing) return;
    const double its_cost = price + (-polygon.area - box.area()) / (spacing * spacing);
    if (its_cost < cost) cost = its_cost, best = box, best_frame = frame;
  };
  for (const double step : kSteps) {
    const Vec2 about = best_frame.along;
    for (int k = -kStepsAside; k <= kStepsAside; ++k) {
      try_direction(Eigen::Rotation2Dd(k * step) * about, 5.0 * kNumberPrice);
    }
  }
  for (const Vec2& direction : directions) try_direction(direction, 4.0 * kNumberPrice);
  if (best.area() == 0.0) return std::nullopt;
  std::vector<Vec2> turned = outline;
  auto sides = sides_of(turned, best_frame, best, spacing);
  if (sides) outline = std::move(turned);
  return sides;
}

}  // namespace pcednet::lines
