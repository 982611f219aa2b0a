#include "workbench/shapes/surfaces/roofs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

namespace pcednet::shapes {
namespace {

constexpr double kHidden = 1e-6;  ///< below another face

/// Half the length and the width, and the height of the ridge.
struct Size {
  double x, y, z;
};

Size random_size(Random& random) {
  const double x = random.uniform(2.0, 5.0), y = x * random.uniform(0.5, 1.0);
  return {x, y, y * random.uniform(0.25, 1.0)};
}

Polyhedron pyramid(Random& random) {
  const Size s = random_size(random);
  return {{{-s.x, -s.y, 0}, {s.x, -s.y, 0}, {s.x, s.y, 0}, {-s.x, s.y, 0}, {0, 0, s.z}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

Polyhedron gable(Random& random) {
  const Size s = random_size(random);
  const double ridge = s.y * random.uniform(-0.3, 0.3);
  return {{{-s.x, -s.y, 0},
           {s.x, -s.y, 0},
           {s.x, s.y, 0},
           {-s.x, s.y, 0},
           {-s.x, ridge, s.z},
           {s.x, ridge, s.z}},
          {{0, 1, 5, 4}, {2, 3, 4, 5}}};
}

Polyhedron hip(Random& random) {
  const Size s = random_size(random);
  const double ridge = s.x * random.uniform(0.2, 0.8);
  return {{{-s.x, -s.y, 0},
           {s.x, -s.y, 0},
           {s.x, s.y, 0},
           {-s.x, s.y, 0},
           {-ridge, 0, s.z},
           {ridge, 0, s.z}},
          {{0, 1, 5, 4}, {1, 2, 5}, {2, 3, 4, 5}, {3, 0, 4}}};
}

/// Steep sides and a level top.
Polyhedron mansard(Random& random) {
  const Size s = random_size(random);
  const double inset = s.y * random.uniform(0.15, 0.5);
  Polyhedron roof;
  for (const double in : {0.0, inset}) {
    const double x = s.x - in, y = s.y - in, z = in > 0.0 ? s.z : 0.0;
    roof.corners.insert(roof.corners.end(), {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
  }
  roof.faces = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
  return roof;
}

/// A wing along -y of the same width and height as the main roof along x, in the shape of an L:
/// a hip outside the corner, a valley inside.
Polyhedron cross(Random& random) {
  const Size s = random_size(random);
  const double width = 0.5 * s.y, wing = width + s.y * random.uniform(0.5, 1.5),
               z = width * random.uniform(0.3, 1.0);
  return {{{-width, width, 0},  // 0: the corner outside
           {s.x, width, 0},     // 1
           {s.x, -width, 0},    // 2
           {width, -width, 0},  // 3: the corner inside
           {width, -wing, 0},   // 4
           {-width, -wing, 0},  // 5
           {0, 0, z},           // 6: where the ridges meet
           {s.x, 0, z},         // 7
           {0, -wing, z}},      // 8
          {{1, 0, 6, 7}, {3, 2, 7, 6}, {4, 3, 6, 8}, {0, 5, 8, 6}}};
}

Polyhedron flat(Random& random) {
  const Size s = random_size(random);
  const double rise = random.index(2) ? 0.0 : 0.5 * s.z;
  return {{{-s.x, -s.y, 0}, {s.x, -s.y, 0}, {s.x, s.y, rise}, {-s.x, s.y, rise}}, {{0, 1, 2, 3}}};
}

/// Five to eight slopes to one point.
Polyhedron tent(Random& random) {
  const Size s = random_size(random);
  const int sides = 5 + static_cast<int>(random.index(4));
  Polyhedron roof;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    roof.corners.emplace_back(s.x * std::cos(angle), s.x * std::sin(angle), 0.0);
    roof.faces.push_back({i, (i + 1) % sides, sides});
  }
  roof.corners.emplace_back(0.0, 0.0, s.z);
  return roof;
}

/// Strips along x from one outline, a list of (y, z), to the other end.
Polyhedron strips(double length, const std::vector<Eigen::Vector2d>& outline) {
  Polyhedron roof;
  for (const Eigen::Vector2d& at : outline) {
    roof.corners.emplace_back(-length, at.x(), at.y());
    roof.corners.emplace_back(length, at.x(), at.y());
  }
  for (int i = 0; i + 3 < static_cast<int>(roof.corners.size()); i += 2) {
    roof.faces.push_back({i, i + 1, i + 3, i + 2});
  }
  return roof;
}

/// Two to four slopes, up and down in turn: with two, a butterfly.
Polyhedron zigzag(Random& random) {
  const Size s = random_size(random);
  const int slopes = 2 + static_cast<int>(random.index(3));
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= slopes; ++i) {
    outline.emplace_back(s.y * (2.0 * i / slopes - 1.0), i % 2 ? 0.0 : 0.5 * s.z);
  }
  return strips(s.x, outline);
}

/// Steep below, flatter above.
Polyhedron gambrel(Random& random) {
  const Size s = random_size(random);
  const double inner = s.y * random.uniform(0.35, 0.7), steep = s.z * random.uniform(0.55, 0.8);
  return strips(s.x, {{-s.y, 0.0}, {-inner, steep}, {0.0, s.z}, {inner, steep}, {s.y, 0.0}});
}

/// A hip above a steeper or flatter skirt.
Polyhedron double_hip(Random& random) {
  const Size s = random_size(random);
  const double inset = s.y * random.uniform(0.25, 0.45), bend = s.z * random.uniform(0.3, 0.7);
  const double ridge = (s.x - inset) * random.uniform(0.2, 0.7);
  Polyhedron roof;
  for (const double in : {0.0, inset}) {
    const double x = s.x - in, y = s.y - in, z = in > 0.0 ? bend : 0.0;
    roof.corners.insert(roof.corners.end(), {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
  }
  roof.corners.insert(roof.corners.end(), {{-ridge, 0, s.z}, {ridge, 0, s.z}});
  roof.faces = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7},
                {4, 5, 9, 8}, {5, 6, 9},    {6, 7, 8, 9}, {7, 4, 8}};
  return roof;
}

/// An L whose two wings end in hips.
Polyhedron angled(Random& random) {
  Polyhedron roof = cross(random);
  const double width = roof.corners[1].y(), in = width * random.uniform(0.6, 1.2);
  roof.corners[7].x() -= in;
  roof.corners[8].y() += in;
  roof.faces.push_back({2, 1, 7});
  roof.faces.push_back({5, 4, 8});
  return roof;
}

/// A gable with a wing towards -y: its eaves begin at y = `eaves` of the main slope, its ridge at
/// y = `ridge`, both end at y = `front`. The main roof goes on below the wing.
Polyhedron with_wing(const Size& s, double at, double width, double ridge, double eaves,
                     double front) {
  const auto height = [&](double y) { return s.z * (1.0 + y / s.y); };
  const double low = height(eaves), high = height(ridge);
  return {{{-s.x, -s.y, 0},
           {at - width, -s.y, 0},
           {at + width, -s.y, 0},
           {s.x, -s.y, 0},
           {s.x, 0, s.z},  // 4
           {-s.x, 0, s.z},
           {s.x, s.y, 0},
           {-s.x, s.y, 0},
           {at, ridge, high},  // 8
           {at, front, high},
           {at - width, eaves, low},  // 10
           {at - width, front, low},
           {at + width, eaves, low},  // 12
           {at + width, front, low}},
          {{4, 5, 0, 1, 2, 3}, {4, 6, 7, 5}, {8, 10, 11, 9}, {9, 13, 12, 8}}};
}

/// A T of two gables: the wing's eaves are as high as the main ones.
Polyhedron tee(Random& random) {
  const Size s = random_size(random);
  const double width = s.y * random.uniform(0.4, 0.8),
               at = (s.x - width) * random.uniform(-0.6, 0.6);
  const double front = -s.y * random.uniform(1.4, 2.2), ridge = -s.y * random.uniform(0.1, 0.5);
  Polyhedron roof = with_wing(s, at, width, ridge, -s.y, front);
  for (std::vector<int>& face : roof.faces) {  // one corner where eaves meet
    std::replace(face.begin(), face.end(), 10, 1);
    std::replace(face.begin(), face.end(), 12, 2);
  }
  return roof;
}

/// A gable with a dormer: eaves of its own above the main slope, no wall.
Polyhedron dormer(Random& random) {
  const Size s = random_size(random);
  const double width = s.y * random.uniform(0.2, 0.4),
               at = (s.x - width) * random.uniform(-0.6, 0.6);
  const double front = -s.y * random.uniform(0.65, 0.85), ridge = -s.y * random.uniform(0.1, 0.25);
  const double eaves = ridge + (front - ridge) * random.uniform(0.3, 0.6);
  Polyhedron roof = with_wing({s.x, s.y, std::max(s.z, 0.5 * s.y)}, at, width, ridge, eaves, front);
  roof.faces[0] = {4, 5, 0, 3};
  return roof;
}

/// A part at another height than the rest, both level or in one slope.
Polyhedron levels(Random& random) {
  const Size s = random_size(random);
  const double step = random.uniform(0.8, 3.0), wall = s.x * random.uniform(-0.4, 0.4);
  const double rise = random.index(2) ? 0.0 : 0.5 * s.z;
  return {{{-s.x, -s.y, 0},
           {wall, -s.y, 0},
           {wall, s.y, rise},
           {-s.x, s.y, rise},
           {wall, -s.y, step},
           {s.x, -s.y, step},
           {s.x, s.y, step + rise},
           {wall, s.y, step + rise}},
          {{0, 1, 2, 3}, {4, 5, 6, 7}}};
}

struct Kind {
  const char* name;
  Polyhedron (*make)(Random& random);
};

constexpr std::array<Kind, kRoofKinds> kKinds = {{{"pyramid", pyramid},
                                                  {"gable", gable},
                                                  {"hip", hip},
                                                  {"mansard", mansard},
                                                  {"cross", cross},
                                                  {"flat", flat},
                                                  {"tent", tent},
                                                  {"zigzag", zigzag},
                                                  {"gambrel", gambrel},
                                                  {"double_hip", double_hip},
                                                  {"angled", angled},
                                                  {"tee", tee},
                                                  {"dormer", dormer},
                                                  {"levels", levels}}};

/// The height of the face there, if it is beneath or above the place.
std::optional<double> height_at(const Polyhedron& roof, const std::vector<int>& face,
                                const Vec3& place) {
  constexpr double kOn = 1e-9;
  const auto corner = [&](std::size_t i) -> const Vec3& {
    return roof.corners[static_cast<std::size_t>(face[i % face.size()])];
  };
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Vec3 side = corner(i + 1) - corner(i), to = place - corner(i);
    if (side.x() * to.y() - side.y() * to.x() < -kOn) return std::nullopt;
  }
  const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const Vec3 to = place - corner(0);
  return corner(0).z() - (normal.x() * to.x() + normal.y() * to.y()) / normal.z();
}

/// The height of the highest face there above the place; 0 or less if none is above.
double cover_above(const Polyhedron& roof, const Vec3& place) {
  double cover = 0.0;
  for (const std::vector<int>& face : roof.faces) {
    cover = std::max(cover, height_at(roof, face, place).value_or(place.z()) - place.z());
  }
  return cover;
}

/// The number of faces on which the place is.
std::ptrdiff_t faces_at(const Polyhedron& roof, const Vec3& place) {
  return std::count_if(roof.faces.begin(), roof.faces.end(), [&](const std::vector<int>& face) {
    const auto height = height_at(roof, face, place);
    return height && std::abs(*height - place.z()) < kHidden;
  });
}

}  // namespace

const char* roof_kind_name(int kind) {
  return kKinds.at(static_cast<std::size_t>(kind)).name;
}

Polyhedron random_roof(int kind, Random& random) {
  return kKinds.at(static_cast<std::size_t>(kind)).make(random);
}

std::optional<double> highest_at(const Polyhedron& roof, const Vec3& place) {
  std::optional<double> highest;
  for (const std::vector<int>& face : roof.faces) {
    highest = std::max(highest, height_at(roof, face, place));  // none is below all
  }
  return highest;
}

bool is_seen(const Polyhedron& roof, const Vec3& place) {
  return cover_above(roof, place) < kHidden;
}

std::vector<lines::Curve> lines_of(const Polyhedron& surface) {
  std::set<std::pair<int, int>> sides;
  for (const std::vector<int>& face : surface.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      sides.insert(std::minmax(face[i], face[(i + 1) % face.size()]));
    }
  }
  std::vector<lines::Curve> curves;
  for (const auto& [from, to] : sides) {
    const Vec3& a = surface.corners[static_cast<std::size_t>(from)];
    const Vec3& b = surface.corners[static_cast<std::size_t>(to)];
    const Vec3 middle = 0.5 * (a + b);
    if (!is_seen(surface, middle)) continue;
    lines::Curve curve;
    curve.kind = lines::CurveKind::kSegment;
    curve.edge_class = faces_at(surface, middle) == 1 ? kBoundary : kSharpEdge;
    curve.points = {a, b};
    curve.confidence = 1.0;
    curves.push_back(curve);
  }
  return curves;
}

}  // namespace pcednet::shapes
