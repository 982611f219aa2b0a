#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/vec3.h"

namespace pcednet::shapes {

/// A point of a surface patch.
struct SurfacePoint {
  Vec3 position;
  Vec3 normal;     ///< unit, out of the solid
  double density;  ///< area per unit of (u, v); 0 where the patch is trimmed
};

/// A piece of surface over the unit square.
struct SurfacePatch {
  std::function<SurfacePoint(double u, double v)> at;
  double max_density;  ///< upper bound of the density
};

struct Segment {
  Vec3 a;
  Vec3 b;
};

/// The points centre + radius (cos(t) x + sin(t) y) for t in [0, angle]; x and y are unit and
/// orthogonal, angle is in (0, 2 pi].
struct Arc {
  Vec3 centre;
  Vec3 x;
  Vec3 y;
  double radius;
  double angle;
};

/// A true edge: a curve where two patches meet at an angle.
struct EdgeCurve {
  std::variant<Segment, Arc> curve;
  /// kSharpEdge, or kSmoothEdge for a crease too weak or too rounded to be sharp.
  EdgeClass strength = kSharpEdge;
};

/// A surface with its true edges; the patches need not enclose anything.
struct Shape {
  std::vector<SurfacePatch> patches;
  std::vector<EdgeCurve> edges;
  std::vector<Segment> rims = {};  ///< where the surface ends, as far as that is known
};

/// Adds `part`, moved by `motion`, to `shape`.
void append(Shape& shape, const Shape& part,
            const Eigen::Isometry3d& motion = Eigen::Isometry3d::Identity());

/// The area of the patches, by the midpoint rule (within 0.1 % for the shapes of this room).
double surface_area(const Shape& shape);

double distance(const Segment& segment, const Vec3& point);
double distance(const Arc& arc, const Vec3& point);

/// The class of a crease between patches with unit normals `a` and `b`: sharp from an angle of 30
/// degrees, smooth from 12 degrees, otherwise no edge.
EdgeClass crease_strength(const Vec3& a, const Vec3& b);

/// The widths of the labelled bands along edges, as lengths.
struct EdgeBands {
  double sharp = 0.0;
  double smooth = 0.0;
};

EdgeBands operator*(double factor, const EdgeBands& bands);

/// The class at a distance from a sharp edge.
EdgeClass class_at(double distance, const EdgeBands& bands);

/// The class of each position from its exact distance to the edges: kSharpEdge nearer than
/// `bands.sharp` to a sharp curve, kSmoothEdge nearer than `bands.smooth` to any, else kNonEdge.
std::vector<std::uint8_t> label_by_distance(std::span<const Vec3> positions,
                                            std::span<const EdgeCurve> edges,
                                            const EdgeBands& bands);

/// The width of the band along the rims that is labelled boundary, in spacings.
inline constexpr double kBoundaryBand = 0.7;

/// Adds to `shape` the borders of its patches over the unit square, in short chords, except those
/// on one of its edges. Not for patches that are trimmed, closed or joined without an edge.
void add_rims(Shape& shape);

/// Labels non-edge points nearer than `width` to a rim kBoundary.
void label_rims(std::span<const Vec3> positions, std::span<const Segment> rims, double width,
                std::span<std::uint8_t> labels);

}  // namespace pcednet::shapes
