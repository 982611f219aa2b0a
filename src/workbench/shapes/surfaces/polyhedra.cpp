#include "workbench/shapes/surfaces/polyhedra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "pcednet/core/sort_unique.h"
#include "workbench/shapes/surfaces/patches.h"

namespace pcednet::shapes {
namespace {

const double kGolden = std::numbers::phi;

Vec3 face_normal(const Polyhedron& solid, const std::vector<int>& face) {
  const Vec3& a = solid.corners[face[0]];
  return (solid.corners[face[1]] - a).cross(solid.corners[face[2]] - a).normalized();
}

/// For each direction the face of the corners that lie farthest that way, counter-clockwise.
std::vector<std::vector<int>> faces_towards(const std::vector<Vec3>& corners,
                                            const std::vector<Vec3>& directions) {
  std::vector<std::vector<int>> faces;
  for (const Vec3& direction : directions) {
    double reach = 0.0;
    for (const Vec3& corner : corners) reach = std::max(reach, corner.dot(direction));
    std::vector<std::pair<double, int>> ring;
    const Vec3 x = direction.unitOrthogonal();
    const Vec3 y = direction.cross(x);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i].dot(direction) < reach - 1e-9) continue;
      ring.emplace_back(std::atan2(corners[i].dot(y), corners[i].dot(x)), static_cast<int>(i));
    }
    std::sort(ring.begin(), ring.end());
    std::vector<int>& face = faces.emplace_back();
    for (const auto& [angle, corner] : ring) face.push_back(corner);
  }
  return faces;
}

/// (0, +-a, +-b) and its cyclic permutations.
void add_cyclic(std::vector<Vec3>& points, double a, double b) {
  for (const double p : {a, -a}) {
    for (const double q : {b, -b}) {
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 point = Vec3::Zero();
        point[(axis + 1) % 3] = p;
        point[(axis + 2) % 3] = q;
        points.push_back(point.normalized());
      }
    }
  }
}

std::vector<Vec3> icosahedron_corners() {
  std::vector<Vec3> corners;
  add_cyclic(corners, 1.0, kGolden);
  return corners;
}

std::vector<Vec3> dodecahedron_corners() {
  std::vector<Vec3> corners;
  add_cyclic(corners, kGolden, 1.0 / kGolden);
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      for (const double z : {1.0, -1.0}) corners.push_back(Vec3(x, y, z).normalized());
    }
  }
  return corners;
}

using Cell = std::array<int, 3>;

/// Space cut into cells by every plane of every box.
struct CellGrid {
  std::array<std::vector<double>, 3> planes;
  std::vector<bool> filled;

  int cells(int axis) const { return static_cast<int>(planes[axis].size()) - 1; }
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * cells(1) + c[1]) * cells(0) + c[0];
  }
  bool is_filled(const Cell& c) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (c[axis] < 0 || c[axis] >= cells(axis)) return false;
    }
    return filled[index(c)];
  }
  Vec3 corner(const Cell& c) const { return {planes[0][c[0]], planes[1][c[1]], planes[2][c[2]]}; }
};

CellGrid make_grid(std::span<const Box> boxes) {
  CellGrid grid;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& planes = grid.planes[axis];
    for (const Box& box : boxes) planes.insert(planes.end(), {box.low[axis], box.high[axis]});
    sort_unique(planes);
  }
  grid.filled.resize(static_cast<std::size_t>(grid.cells(0)) * grid.cells(1) * grid.cells(2));
  Cell c;
  for (c[2] = 0; c[2] < grid.cells(2); ++c[2]) {
    for (c[1] = 0; c[1] < grid.cells(1); ++c[1]) {
      for (c[0] = 0; c[0] < grid.cells(0); ++c[0]) {
        const Vec3 low = grid.corner(c);
        for (const Box& box : boxes) {
          if ((low.array() >= box.low.array()).all() && (low.array() < box.high.array()).all()) {
            grid.filled[grid.index(c)] = box.filled;
          }
        }
      }
    }
  }
  return grid;
}

/// Calls `action(corner)` for every corner of the grid.
template <typename Action>
void for_each_corner(const CellGrid& grid, const Action& action) {
  Cell c;
  for (c[2] = 0; c[2] <= grid.cells(2); ++c[2]) {
    for (c[1] = 0; c[1] <= grid.cells(1); ++c[1]) {
      for (c[0] = 0; c[0] <= grid.cells(0); ++c[0]) action(c);
    }
  }
}

Cell stepped(Cell c, int axis, int steps = 1) {
  c[axis] += steps;
  return c;
}

/// The face of cell `c` towards lower `axis`, if just one side of it is filled.
void add_face(Shape& shape, const CellGrid& grid, const Cell& c, int axis) {
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  if (c[a] >= grid.cells(a) || c[b] >= grid.cells(b)) return;
  const bool above = grid.is_filled(c);
  if (above == grid.is_filled(stepped(c, axis, -1))) return;
  const Vec3 origin = grid.corner(c);
  const Vec3 along = grid.corner(stepped(c, a)) - origin;
  const Vec3 across = grid.corner(stepped(c, b)) - origin;
  shape.patches.push_back(above ? parallelogram(origin, across, along)
                                : parallelogram(origin, along, across));
}

/// The line from corner `c` along `axis`, if the surface turns at it: unless the four cells around
/// it are filled in equal pairs side by side.
void add_edge(Shape& shape, const CellGrid& grid, const Cell& c, int axis) {
  if (c[axis] >= grid.cells(axis)) return;
  const Cell left = stepped(c, (axis + 1) % 3, -1);
  const int b = (axis + 2) % 3;
  const bool right_up = grid.is_filled(c);
  const bool right_down = grid.is_filled(stepped(c, b, -1));
  const bool left_up = grid.is_filled(left);
  const bool left_down = grid.is_filled(stepped(left, b, -1));
  const bool flat = (right_up == right_down && left_up == left_down) ||
                    (right_up == left_up && right_down == left_down);
  if (flat) return;
  shape.edges.push_back({Segment{grid.corner(c), grid.corner(stepped(c, axis))}});
}

/// Corner `k` of the outline after `u` of the turn.
Vec2 corner(const Loft& loft, std::size_t k, double u) {
  const std::size_t i = k % loft.first.size();
  return (1.0 - u) * loft.first[i] + u * loft.last[i];
}

Vec3 turned(const Vec2& p, double angle) {
  return {p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()};
}

/// The surface swept by the side from corner k to the next.
SurfacePoint strip_point(const Loft& loft, std::size_t k, double u, double v) {
  const Vec2 a = corner(loft, k, u);
  const Vec2 b = corner(loft, k + 1, u);
  const Vec2 p = (1.0 - v) * a + v * b;
  const std::size_t i = k % loft.first.size();
  const std::size_t j = (k + 1) % loft.first.size();
  const Vec2 change =
      (1.0 - v) * (loft.last[i] - loft.first[i]) + v * (loft.last[j] - loft.first[j]);
  const double t = u * loft.angle;
  const Vec3 tangent(-std::sin(t), std::cos(t), 0.0);
  const Vec3 along_turn = turned(change, t) + loft.angle * p.x() * tangent;
  const Vec3 along_side = turned(b - a, t);
  const Vec3 cross = along_turn.cross(along_side);
  const double density = cross.norm();
  return {turned(p, t), cross / density, density};
}

SurfacePatch strip(const Loft& loft, std::size_t k) {
  constexpr int kGrid = 32;
  constexpr double kMargin = 1.05;  // above the largest value on the grid: the density is smooth
  double largest = 0.0;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      const SurfacePoint point =
          strip_point(loft, k, static_cast<double>(i) / kGrid, static_cast<double>(j) / kGrid);
      largest = std::max(largest, point.density);
    }
  }
  return {[loft, k](double u, double v) { return strip_point(loft, k, u, v); }, kMargin * largest};
}

void add_corner_curve(Shape& shape, const Loft& loft, std::size_t k) {
  const std::size_t before = k + loft.first.size() - 1;
  for (int i = 0; i < kLoftChords; ++i) {
    const double u0 = static_cast<double>(i) / kLoftChords;
    const double u1 = static_cast<double>(i + 1) / kLoftChords;
    const double middle = 0.5 * (u0 + u1);
    const EdgeClass strength = crease_strength(strip_point(loft, before, middle, 1.0).normal,
                                               strip_point(loft, k, middle, 0.0).normal);
    if (strength == kNonEdge) continue;
    shape.edges.push_back({Segment{turned(corner(loft, k, u0), u0 * loft.angle),
                                   turned(corner(loft, k, u1), u1 * loft.angle)},
                           strength});
  }
}

/// The plane end of the part at u = 0 or 1.
void add_end(Shape& shape, const Loft& loft, double u) {
  // radial x z points against the turn, which is outwards at its start; at its end both the plane's
  // first axis and the outline are mirrored.
  const double side = u == 0.0 ? 1.0 : -1.0;
  const Vec3 radial = turned(Vec2(1.0, 0.0), u * loft.angle);
  std::vector<Vec2> outline;
  for (std::size_t k = 0; k < loft.first.size(); ++k) {
    const Vec2 p = corner(loft, k, u);
    outline.emplace_back(side * p.x(), p.y());
    shape.edges.push_back(
        {Segment{turned(p, u * loft.angle), turned(corner(loft, k + 1, u), u * loft.angle)}});
  }
  shape.patches.push_back(polygon(outline, Vec3::Zero(), side * radial, Vec3::UnitZ()));
}

}  // namespace

Shape make_shape(const Polyhedron& solid) {
  Shape shape;
  std::map<std::pair<int, int>, Vec3> open;  // edges seen from one face, with its normal
  for (const std::vector<int>& face : solid.faces) {
    const Vec3 normal = face_normal(solid, face);
    const std::size_t n = face.size();
    for (std::size_t i = 0; i < n; ++i) {
      const int from = face[i];
      const int to = face[(i + 1) % n];
      if (i >= 2) {
        shape.patches.push_back(
            triangle(solid.corners[face[0]], solid.corners[face[i - 1]], solid.corners[from]));
      }
      const auto key = std::minmax(from, to);
      const auto found = open.find(key);
      if (found == open.end()) {
        open.emplace(key, normal);
        continue;
      }
      const EdgeClass strength = crease_strength(found->second, normal);
      if (strength != kNonEdge) {
        shape.edges.push_back({Segment{solid.corners[from], solid.corners[to]}, strength});
      }
      open.erase(found);
    }
  }
  return shape;
}

Polyhedron cube() {
  std::vector<Vec3> corners;
  std::vector<Vec3> axes;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).normalized());
  }
  for (int i = 0; i < 6; ++i) axes.push_back((i < 3 ? 1.0 : -1.0) * Vec3::Unit(i % 3));
  return {corners, faces_towards(corners, axes)};
}

Polyhedron icosahedron() {
  return {icosahedron_corners(), faces_towards(icosahedron_corners(), dodecahedron_corners())};
}

Polyhedron dodecahedron() {
  return {dodecahedron_corners(), faces_towards(dodecahedron_corners(), icosahedron_corners())};
}

Shape make_shape(std::span<const Box> boxes) {
  const CellGrid grid = make_grid(boxes);
  Shape shape;
  for_each_corner(grid, [&](const Cell& c) {
    for (int axis = 0; axis < 3; ++axis) {
      add_face(shape, grid, c, axis);
      add_edge(shape, grid, c, axis);
    }
  });
  return shape;
}

Shape make_shape(const Loft& loft) {
  Shape shape;
  for (std::size_t k = 0; k < loft.first.size(); ++k) {
    shape.patches.push_back(strip(loft, k));
    add_corner_curve(shape, loft, k);
  }
  add_end(shape, loft, 0.0);
  add_end(shape, loft, 1.0);
  return shape;
}

}  // namespace pcednet::shapes
