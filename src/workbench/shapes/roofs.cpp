#include "workbench/shapes/roofs.h"

#include <array>
#include <map>
#include <utility>

namespace pcednet::shapes {
namespace {

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

struct Kind {
  const char* name;
  Polyhedron (*make)(Random& random);
};

constexpr std::array<Kind, kRoofKinds> kKinds = {{{"pyramid", pyramid},
                                                  {"gable", gable},
                                                  {"hip", hip},
                                                  {"mansard", mansard},
                                                  {"cross", cross},
                                                  {"flat", flat}}};

}  // namespace

const char* roof_kind_name(int kind) {
  return kKinds.at(static_cast<std::size_t>(kind)).name;
}

Polyhedron random_roof(int kind, Random& random) {
  return kKinds.at(static_cast<std::size_t>(kind)).make(random);
}

std::vector<lines::Curve> lines_of(const Polyhedron& surface) {
  std::map<std::pair<int, int>, int> faces;
  for (const std::vector<int>& face : surface.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      ++faces[std::minmax(face[i], face[(i + 1) % face.size()])];
    }
  }
  std::vector<lines::Curve> curves;
  for (const auto& [ends, count] : faces) {
    lines::Curve curve;
    curve.kind = lines::CurveKind::kSegment;
    curve.edge_class = count == 1 ? kBoundary : kSharpEdge;
    curve.points = {surface.corners[static_cast<std::size_t>(ends.first)],
                    surface.corners[static_cast<std::size_t>(ends.second)]};
    curve.confidence = 1.0;
    curves.push_back(curve);
  }
  return curves;
}

}  // namespace pcednet::shapes
