#include "workbench/shapes/polyhedra.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "workbench/shapes/patches.h"

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

}  // namespace pcednet::shapes
