#include "workbench/shapes/surfaces/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pcednet/core/parallel.h"

namespace pcednet::shapes {
namespace {

EdgeCurve moved(const EdgeCurve& edge, const Eigen::Isometry3d& motion) {
  EdgeCurve result = edge;
  if (auto* segment = std::get_if<Segment>(&result.curve)) {
    *segment = {motion * segment->a, motion * segment->b};
  } else {
    Arc& arc = std::get<Arc>(result.curve);
    arc.centre = motion * arc.centre;
    arc.x = motion.linear() * arc.x;
    arc.y = motion.linear() * arc.y;
  }
  return result;
}

std::uint8_t label_of(const Vec3& position, std::span<const EdgeCurve> edges,
                      const EdgeBands& bands) {
  std::uint8_t label = kNonEdge;
  for (const EdgeCurve& edge : edges) {
    const double d =
        std::visit([&](const auto& curve) { return distance(curve, position); }, edge.curve);
    if (d < bands.sharp && edge.strength == kSharpEdge) return kSharpEdge;
    if (d < bands.smooth) label = kSmoothEdge;
  }
  return label;
}

constexpr int kChords = 96;  // of each side of a patch
constexpr double kOnEdge = 1e-9;

bool is_on_edge(const Shape& shape, const Vec3& point) {
  return std::any_of(shape.edges.begin(), shape.edges.end(), [&](const EdgeCurve& edge) {
    return std::visit([&](const auto& curve) { return distance(curve, point); }, edge.curve) <
           kOnEdge;
  });
}

}  // namespace

void append(Shape& shape, const Shape& part, const Eigen::Isometry3d& motion) {
  for (const SurfacePatch& patch : part.patches) {
    const auto at = [at = patch.at, motion](double u, double v) {
      SurfacePoint point = at(u, v);
      point.position = motion * point.position;
      point.normal = motion.linear() * point.normal;
      return point;
    };
    shape.patches.push_back({at, patch.max_density});
  }
  for (const EdgeCurve& edge : part.edges) shape.edges.push_back(moved(edge, motion));
  for (const Segment& rim : part.rims) shape.rims.push_back({motion * rim.a, motion * rim.b});
}

double surface_area(const Shape& shape) {
  constexpr int kSteps = 200;
  double sum = 0.0;
  for (const SurfacePatch& patch : shape.patches) {
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        sum += patch.at((i + 0.5) / kSteps, (j + 0.5) / kSteps).density;
      }
    }
  }
  return sum / (kSteps * kSteps);
}

double distance(const Segment& segment, const Vec3& point) {
  const Vec3 along = segment.b - segment.a;
  const double length2 = along.squaredNorm();
  const double t =
      length2 > 0.0 ? std::clamp((point - segment.a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - segment.a - t * along).norm();
}

double distance(const Arc& arc, const Vec3& point) {
  const Vec3 offset = point - arc.centre;
  const double x = offset.dot(arc.x);
  const double y = offset.dot(arc.y);
  double t = std::atan2(y, x);
  if (t < 0.0) t += 2.0 * std::numbers::pi;
  if (t <= arc.angle) {
    const double height2 = std::max(0.0, offset.squaredNorm() - x * x - y * y);
    return std::sqrt(height2 + std::pow(std::hypot(x, y) - arc.radius, 2));
  }
  const Vec3 start = arc.radius * arc.x;
  const Vec3 end = arc.radius * (std::cos(arc.angle) * arc.x + std::sin(arc.angle) * arc.y);
  return std::min((offset - start).norm(), (offset - end).norm());
}

EdgeClass crease_strength(const Vec3& a, const Vec3& b) {
  const double turn = std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
  return turn >= 30.0 ? kSharpEdge : turn >= 12.0 ? kSmoothEdge : kNonEdge;
}

EdgeBands operator*(double factor, const EdgeBands& bands) {
  return {factor * bands.sharp, factor * bands.smooth};
}

EdgeClass class_at(double distance, const EdgeBands& bands) {
  return distance < bands.sharp ? kSharpEdge : distance < bands.smooth ? kSmoothEdge : kNonEdge;
}

std::vector<std::uint8_t> label_by_distance(std::span<const Vec3> positions,
                                            std::span<const EdgeCurve> edges,
                                            const EdgeBands& bands) {
  std::vector<std::uint8_t> labels(positions.size());
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) labels[i] = label_of(positions[i], edges, bands);
  });
  return labels;
}

void add_rims(Shape& shape) {
  const std::array<std::array<double, 2>, 5> corners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  for (const SurfacePatch& patch : shape.patches) {
    for (std::size_t side = 0; side < 4; ++side) {
      const auto at = [&](int i) {
        const double t = static_cast<double>(i) / kChords;
        const auto& a = corners[side];
        const auto& b = corners[side + 1];
        return patch.at(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])).position;
      };
      for (int i = 0; i < kChords; ++i) {
        const Segment chord = {at(i), at(i + 1)};
        if (!is_on_edge(shape, 0.5 * (chord.a + chord.b))) shape.rims.push_back(chord);
      }
    }
  }
}

void label_rims(std::span<const Vec3> positions, std::span<const Segment> rims, double width,
                std::span<std::uint8_t> labels) {
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (labels[i] != kNonEdge) continue;
      const bool near = std::any_of(rims.begin(), rims.end(), [&](const Segment& rim) {
        return distance(rim, positions[i]) < width;
      });
      if (near) labels[i] = kBoundary;
    }
  });
}

}  // namespace pcednet::shapes
