#include "workbench/shapes/solids/cad_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "pcednet/core/random_vectors.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/solids/turned_parts.h"

namespace pcednet::shapes {
namespace {

Solid plate(Random& random) {
  const double x = random.uniform(0.35, 0.5), y = random.uniform(0.1, 0.5),
               z = size_between(random, 0.015, 0.12);
  Solid part;
  const CornerShape rim = any_shape(random);
  const double rim_size = random.uniform(0.1, 0.45) * z;
  if (chance(random, 0.5)) {
    const double round = random.uniform(0.1, 0.9) * y;
    part.add(prism(rectangle(x, y, any_shape(random), round), z, at(Vec3::Zero()), rim, rim_size));
  } else {
    part.add(prism(random_outline(random, 0.5), z, at(Vec3::Zero()), rim, rim_size));
  }
  const int holes = 1 + static_cast<int>(random.index(7));
  for (int i = 0; i < holes; ++i) {
    const bool blind = chance(random, 0.35);
    const double depth = blind ? random.uniform(0.6, 1.4) * z : 2.0 * z + 1.0;
    const double radius = size_between(random, 0.015, 0.3) * std::min(y, 0.35);
    const double u = random.uniform(-0.75, 0.75) * x, v = random.uniform(-0.7, 0.7) * y;
    drill(part, random, {u, v}, radius, z, depth);
  }
  return part;
}

Solid bracket(Random& random) {
  const double width = random.uniform(0.1, 0.4), thick = size_between(random, 0.015, 0.06);
  const double reach = random.uniform(0.3, 0.5), height = random.uniform(0.2, 0.5);
  const double bend = random.uniform(0.3, 2.5) * thick;
  const CornerShape inner = any_shape(random), outer = any_shape(random);
  std::vector<Corner> corners;
  if (chance(random, 0.5)) {  // L
    corners = {{{0, 0}, outer, bend + thick}, {{reach, 0}},      {{reach, thick}},
               {{thick, thick}, inner, bend}, {{thick, height}}, {{0, height}}};
  } else {  // U
    corners = {{{0, 0}, outer, bend + thick},
               {{reach, 0}, outer, bend + thick},
               {{reach, height}},
               {{reach - thick, height}},
               {{reach - thick, thick}, inner, bend},
               {{thick, thick}, inner, bend},
               {{thick, height}},
               {{0, height}}};
  }
  Solid part;
  part.add(prism(outline(corners), width, along(1, Vec3::Zero()),
                 chance(random, 0.3) ? CornerShape::kFillet : CornerShape::kSharp, 0.3 * thick));
  // The prism's y runs against z: holes go through both legs.
  for (int i = 0; i < 3; ++i) {
    const double radius = size_between(random, 0.1, 0.35) * width;
    const double u = random.uniform(0.3, 0.9), v = random.uniform(-0.6, 0.6) * width;
    if (chance(random, 0.6)) {
      part.cut(cylinder(radius, 1.0, at({u * reach, v, 0.0})));
    } else {
      part.cut(cylinder(radius, chance(random, 0.5) ? 0.1 : 2.0, along(0, {0.0, v, -u * height})));
    }
  }
  if (chance(random, 0.5)) {
    const double rib = random.uniform(0.3, 0.6);
    part.add(prism(outline({{{0.9 * thick, 0.9 * thick}},
                            {{rib * reach, 0.9 * thick}},
                            {{0.9 * thick, rib * height}}}),
                   0.4 * thick, along(1, {0.0, random.uniform(-0.5, 0.5) * width, 0.0})));
  }
  return part;
}

Solid block(Random& random) {
  const Vec3 half = uniform_vector(random, {0.2, 0.2, 0.1}, {0.5, 0.5, 0.35});
  Solid part;
  const double rim_size = random.uniform(0.01, 0.06);
  const CornerShape rim = any_shape(random);
  const double round = random.uniform(0.02, 0.1);
  part.add(prism(rectangle(half.x(), half.y(), any_shape(random), round), half.z(),
                 at(Vec3::Zero()), rim, rim_size));
  const int features = 2 + static_cast<int>(random.index(6));
  for (int i = 0; i < features; ++i) {
    const double v = random.uniform(-0.8, 0.8) * half.y(), u = random.uniform(-0.8, 0.8) * half.x();
    const Vec3 place(u, v, half.z());
    const double size = size_between(random, 0.03, 0.25);
    switch (random.index(6)) {
      case 0: {
        const double depth = random.uniform(0.05, 0.3);
        const CornerShape shape = any_shape(random);
        const double width = random.uniform(0.4, 1.0) * size;
        part.cut(prism(rectangle(size, width, shape, 0.3 * size), depth, at(place)));
        break;
      }
      case 1: {
        const CornerShape rim_there = any_shape(random);
        const double height = random.uniform(0.03, 0.2);
        part.add(cylinder(0.6 * size, height, at(place), rim_there, 0.15 * size));
        break;
      }
      case 2:
        part.add(box(0.2 * size, size, random.uniform(0.03, 0.2), place));
        break;
      case 3: {  // a slanted cut of a corner
        Eigen::Isometry3d frame = at({(chance(random, 0.5) ? 1 : -1) * half.x(), 0, half.z()});
        frame.rotate(Eigen::AngleAxisd(random.uniform(0.2, 1.3), Vec3::UnitY()));
        part.cut(prism(rectangle(size, 2.0), 0.5 * size, frame));
        break;
      }
      case 4: {
        const Vec3 within = place - Vec3(0, 0, random.uniform(0, 1) * half.z());
        part.cut(cylinder(0.5 * size, 2.0, along(static_cast<int>(random.index(3)), within)));
        break;
      }
      default:
        drill(part, random, {place.x(), place.y()}, 0.5 * size, half.z(),
              random.uniform(0.3, 3.0) * half.z());
    }
  }
  return part;
}

Solid grille(Random& random) {
  const double thick = size_between(random, 0.01, 0.06);
  Solid part;
  const CornerShape rim = any_shape(random);
  part.add(prism(rectangle(0.5, 0.4, any_shape(random), 0.08), thick, at(Vec3::Zero()), rim,
                 0.3 * thick));
  const int columns = 3 + static_cast<int>(random.index(6)),
            rows = 2 + static_cast<int>(random.index(5));
  const int kind = static_cast<int>(random.index(4));
  const double rx = 0.45 / columns, ry = 0.35 / rows, grow = random.uniform(0.3, 0.8);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double x = (2 * i + 1 - columns) * rx, y = (2 * j + 1 - rows) * ry;
      const double r = std::min(rx, ry) * grow * (0.5 + 0.5 * (i + 1.0) / columns);
      const double z = chance(random, 0.2) ? thick : 0.0;
      if (kind == 0) part.cut(cylinder(r, thick + 0.01, at({x, y, z})));
      if (kind == 1)
        part.cut(
            prism(rectangle(r, r, CornerShape::kFillet, 0.2 * r), thick + 0.01, at({x, y, z})));
      if (kind == 2)
        part.add(cylinder(r, 2.0 * thick, at({x, y, thick}), any_shape(random), 0.2 * r));
      if (kind == 3) part.add(prism(regular_polygon(6, r), 3.0 * thick, at({x, y, thick})));
    }
  }
  return part;
}

Solid housing(Random& random) {
  const double x = random.uniform(0.3, 0.5), y = random.uniform(0.2, 0.4),
               z = random.uniform(0.1, 0.3);
  const double wall = size_between(random, 0.008, 0.05);
  const CornerShape shape = any_shape(random);
  const double round = random.uniform(0.05, 0.15);
  Solid part;
  const double outer_rim = random.uniform(0.2, 1.2) * wall;
  part.add(prism(rectangle(x, y, shape, round + wall), z, at(Vec3::Zero()), any_shape(random),
                 outer_rim));
  const double inner_rim = random.uniform(0.3, 1.5) * wall;
  part.cut(prism(rectangle(x - wall, y - wall, shape, round), z, at({0, 0, 1.2 * wall}),
                 any_shape(random), inner_rim));
  for (int i = 0; i < 4; ++i) {  // posts in the corners, holes in the walls
    const double px = (i % 2 ? 1 : -1) * (x - 3.0 * wall), py = (i / 2 ? 1 : -1) * (y - 3.0 * wall);
    if (chance(random, 0.7)) {
      part.add(cylinder(1.6 * wall, 0.8 * z, at({px, py, -0.2 * z})));
      part.cut(cylinder(0.8 * wall, 0.5 * z, at({px, py, 0.6 * z})));
    }
    if (chance(random, 0.5)) {
      const Vec3 place(i % 2 ? px : x, i % 2 ? y : py, random.uniform(-0.2, 0.4) * z);
      part.cut(cylinder(random.uniform(0.1, 0.4) * z, 0.5, along(i % 2, place)));
    }
  }
  if (chance(random, 0.5))
    part.add(
        box(0.5 * wall, y - 0.5 * wall, 0.7 * z, {random.uniform(-0.5, 0.5) * x, 0, -0.3 * z}));
  return part;
}

Volume any_volume(Random& random, double size, double tall, const Eigen::Isometry3d& frame) {
  const bool is_prism = chance(random, 0.4), is_cylinder = !is_prism && chance(random, 0.5);
  const CornerShape rim = any_shape(random);
  const double rim_size = 0.1 * std::min(size, tall);
  if (is_prism) return prism(random_outline(random, size), tall, frame, rim, rim_size);
  if (is_cylinder) return cylinder(0.7 * size, tall, frame, rim, 0.2 * std::min(size, tall));
  const CornerShape shape = any_shape(random);
  const double width = random.uniform(0.3, 1) * size;
  return prism(rectangle(size, width, shape, 0.2 * size), tall, frame, rim, rim_size);
}

/// Anything joined to anything, at any angle.
Solid assembly(Random& random) {
  Solid part;
  const int pieces = 2 + static_cast<int>(random.index(4));
  for (int i = 0; i < pieces; ++i) {
    Eigen::Isometry3d frame =
        at(uniform_vector(random, Vec3::Constant(-0.25), Vec3::Constant(0.25)));
    const double tilt = chance(random, 0.5)
                            ? 0.5 * std::numbers::pi * static_cast<double>(random.index(4))
                            : random.uniform(0, 2 * std::numbers::pi);
    const Vec3 axes[] = {Vec3::UnitX(), Vec3::UnitY(), Vec3(1, 1, 1).normalized()};
    frame.rotate(Eigen::AngleAxisd(tilt, axes[random.index(3)]));
    const double size = random.uniform(0.12, 0.35), tall = size_between(random, 0.03, 0.4);
    Volume volume = any_volume(random, size, tall, frame);
    if (i > 1 && chance(random, 0.35)) {
      part.cut(std::move(volume));
    } else {
      part.add(std::move(volume));
    }
  }
  return part;
}

struct Family {
  const char* name;
  Solid (*make)(Random& random);
};

constexpr std::array<Family, kPartFamilies> kFamilies = {{{"plate", plate},
                                                          {"bracket", bracket},
                                                          {"shaft", shaft},
                                                          {"flange", flange},
                                                          {"gear", gear},
                                                          {"block", block},
                                                          {"grille", grille},
                                                          {"housing", housing},
                                                          {"ring", ring},
                                                          {"dome", dome},
                                                          {"knob", knob},
                                                          {"assembly", assembly}}};

}  // namespace

std::string part_family_name(int family) {
  return kFamilies.at(static_cast<std::size_t>(family)).name;
}

Solid random_part(int family, Random& random) {
  return kFamilies.at(static_cast<std::size_t>(family)).make(random);
}

}  // namespace pcednet::shapes
