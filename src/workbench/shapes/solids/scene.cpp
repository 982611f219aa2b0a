#include "workbench/shapes/solids/scene.h"

#include <array>
#include <cmath>

#include "workbench/shapes/solids/part_pieces.h"

namespace pcednet::shapes {
namespace {

void add_ground(Scene& scene, Random& random) {
  Eigen::Isometry3d frame = at({0, 0, -0.5});
  frame.rotate(Eigen::AngleAxisd(random.uniform(-0.03, 0.03), Vec3::UnitX()));
  scene.solid.add(prism(rectangle(7, 7), 0.5, frame));
}

/// Leaves within a ball, more of them outside.
void add_bush(Scene& scene, Random& random, const Vec3& centre, double radius) {
  const int leaves = static_cast<int>(400.0 * radius * radius) + 100;
  for (int i = 0; i < leaves; ++i) {
    const Vec3 out = any_direction(random);
    scene.foliage.push_back(centre + radius * std::cbrt(random.uniform(0.2, 1.0)) * out);
  }
}

/// A pipe from corner to corner of a path along the axes.
void add_pipe(Solid& solid, const Vec3& from, int axis, double length, double radius) {
  Vec3 middle = from;
  middle[axis] += 0.5 * length;
  solid.add(cylinder(radius, 0.5 * std::abs(length), along(axis, middle)));
}

void add_windows(Solid& solid, Random& random, double width, double height, double front) {
  const int columns = 2 + static_cast<int>(random.index(4)),
            rows = 1 + static_cast<int>(random.index(3));
  const double depth = random.uniform(0.08, 0.35), arch = random.uniform();
  const double sill = random.uniform(0.05, 0.2);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double w = 0.28 * 2.0 * width / columns, h = 0.3 * height / rows;
      const Vec3 centre((2 * i + 1 - columns) * width / columns, front, (j + 0.55) * height / rows);
      if (arch < 0.3) {  // round above
        solid.cut(prism(slot_profile({0, -0.4 * h}, {0, 0.4 * h}, w), depth, along(1, centre)));
      } else {
        solid.cut(box(w, depth, h, centre));
      }
      if (arch < 0.6) solid.add(box(1.2 * w, sill, 0.04, centre - Vec3(0, 0, h + 0.04)));
      if (arch > 0.5) {  // frame and crossbar
        solid.add(box(0.04, 0.03, h, centre + Vec3(0, depth - 0.03, 0)));
        solid.add(box(w, 0.03, 0.04, centre + Vec3(0, depth - 0.03, 0.3 * h)));
      }
    }
  }
}

Scene facade(Random& random) {
  Scene scene;
  add_ground(scene, random);
  Solid& solid = scene.solid;
  const double width = random.uniform(3, 5), height = random.uniform(3, 7), front = 2.0;
  solid.add(box(width, 0.5, 0.5 * height, {0, front + 0.5, 0.5 * height}));
  add_windows(solid, random, width, height, front);
  solid.cut(box(0.5, 0.3, 1.1, {random.uniform(-0.5, 0.5) * width, front, 1.0}));
  for (int i = 0; i < 3; ++i) {  // cornice
    solid.add(box(width + 0.05 * i, 0.08 + 0.06 * i, 0.06, {0, front, height - 0.3 + 0.12 * i}));
  }
  solid.add(box(width, 0.1, random.uniform(0.1, 0.4), {0, front, 0}));  // plinth
  const int pillars = static_cast<int>(random.index(5));
  for (int i = 0; i < pillars; ++i) {
    const double x = (2.0 * i + 1 - pillars) * width / pillars;
    if (chance(random, 0.5)) {
      solid.add(
          cylinder(random.uniform(0.1, 0.25), 0.5 * height, at({x, front - 0.1, 0.5 * height})));
    } else {
      solid.add(box(random.uniform(0.1, 0.3), 0.12, 0.5 * height, {x, front, 0.5 * height}));
    }
  }
  if (chance(random, 0.6)) add_pipe(solid, {0.92 * width, front - 0.1, 0}, 2, height, 0.06);
  if (chance(random, 0.5)) {
    solid.add(box(1.0, 0.5, 0.08, {0, front - 0.4, 0.55 * height}));  // balcony
    solid.add(box(1.0, 0.03, 0.4, {0, front - 0.87, 0.55 * height + 0.4}));
  }
  for (int i = 0; i < 3; ++i) {
    const double radius = random.uniform(0.2, 0.8);
    add_bush(scene, random,
             {random.uniform(-4, 4), random.uniform(-1, 1.5), random.uniform(0.3, 0.8)}, radius);
  }
  if (chance(random, 0.5))
    solid.add(prism(rectangle(0.9, 0.45, CornerShape::kFillet, 0.15), 0.5, at({2, 0, 0.5}),
                    CornerShape::kFillet, 0.12));
  scene.scanners = {{{random.uniform(-3, 3), -5, 1.7}, {0, front, 0.4 * height}},
                    {{4, -3, 1.7}, {0, front, 0.4 * height}},
                    {{-5, -2, 1.7}, {0, front, 0.4 * height}}};
  return scene;
}

Scene yard(Random& random) {
  Scene scene;
  add_ground(scene, random);
  Solid& solid = scene.solid;
  const int steps = 3 + static_cast<int>(random.index(6));
  const double rise = random.uniform(0.12, 0.25), tread = random.uniform(0.25, 0.45),
               width = random.uniform(0.8, 2.5);
  for (int i = 0; i < steps; ++i) {
    solid.add(box(width, 0.5 * tread * (steps - i), 0.5 * rise,
                  {-1.5, 3.0 - 0.5 * tread * (steps - i), (i + 0.5) * rise}));
  }
  solid.add(box(0.12, 0.5 * tread * steps, 0.5, {-1.5 + width, 3.0 - 0.5 * tread * steps, 0.5}));
  for (int i = 0; i < 4; ++i) {
    const double radius = size_between(random, 0.03, 0.2);
    const double length = random.uniform(1, 4);
    const int axis = static_cast<int>(random.index(3));
    add_pipe(solid,
             {random.uniform(0, 3), 3.0 - random.uniform(0.1, 1.5), random.uniform(0.2, 2.5)}, axis,
             length, radius);
  }
  solid.add(box(4, 0.15, 1.4, {0, 3.2, 1.4}));
  for (int i = 0; i < 4; ++i) {
    const double size = random.uniform(0.2, 0.6);
    Eigen::Isometry3d frame = at({random.uniform(-3, 3), random.uniform(-1, 2), 0.9 * size});
    frame.rotate(Eigen::AngleAxisd(random.uniform(0, 6), Vec3::UnitZ()));
    if (chance(random, 0.4))
      frame.rotate(Eigen::AngleAxisd(random.uniform(-0.4, 0.4), Vec3::UnitX()));
    const bool is_round = chance(random, 0.3);
    const CornerShape rim = any_shape(random);
    solid.add(is_round ? cylinder(0.6 * size, size, frame, rim, 0.1 * size)
                       : prism(rectangle(size, random.uniform(0.4, 1) * size), size, frame, rim,
                               0.1 * size));
  }
  solid.add(prism(outline({{{-1, 0}}, {{1, 0}}, {{1, 0.5}}}), 0.6, along(1, {3, 1, 0})));
  for (int i = 0; i < 4; ++i) {
    const double radius = random.uniform(0.2, 0.7);
    add_bush(scene, random, {random.uniform(-4, 4), random.uniform(0, 3), random.uniform(0.2, 1.5)},
             radius);
  }
  scene.scanners = {{{random.uniform(-2, 2), -4, 1.7}, {0, 2, 0.8}},
                    {{4, -2, 1.7}, {0, 2, 0.8}},
                    {{-4, -1, 1.7}, {0, 2, 0.8}}};
  return scene;
}

Scene room(Random& random) {
  Scene scene;
  Solid& solid = scene.solid;
  const double x = random.uniform(1.8, 3.5), y = random.uniform(1.5, 3),
               z = random.uniform(1.2, 1.7);
  solid.add(box(x + 0.3, y + 0.3, z + 0.3, {0, 0, z}));
  solid.cut(box(x, y, z, {0, 0, z}));
  solid.cut(box(0.2, 0.45, 1.05, {x, random.uniform(-0.5, 0.5) * y, 1.05}));  // door
  const Vec3 window(random.uniform(-0.4, 0.4) * x, y, 1.4);
  solid.cut(box(random.uniform(0.4, 0.9), 0.2, 0.6, window));
  solid.add(box(x, 0.02, 0.08, {0, y, 0.08}));  // skirting
  const int beams = static_cast<int>(random.index(4));
  for (int i = 0; i < beams; ++i) {
    solid.add(box(x, 0.1, 0.12, {0, (2.0 * i + 1 - beams) * y / beams, 2 * z - 0.12}));
  }
  for (int i = 0; i < 3; ++i) {
    const double radius = random.uniform(0.02, 0.1);
    add_pipe(solid, {-x + random.uniform(0.08, 0.3), -y + 0.15, random.uniform(0.3, 2.0) * z}, 1,
             2.0 * y - 0.3, radius);
  }
  if (chance(random, 0.7))
    solid.add(
        cylinder(0.15, z, at({random.uniform(-0.6, 0.6) * x, random.uniform(-0.6, 0.6) * y, z})));
  solid.add(box(0.6, 0.35, 0.03, {random.uniform(-0.4, 0.4) * x, 0.5 * y, 0.75}));  // table
  solid.add(box(0.05, 0.05, 0.36, {0.2, 0.5 * y, 0.36}));
  for (int i = 0; i < 4; ++i) {
    const CornerShape rim = any_shape(random);
    const double u = random.uniform(-0.8, 0.8) * x, v = random.uniform(-0.8, 0.8) * y;
    const double height = random.uniform(0.2, 0.9);
    const CornerShape shape = any_shape(random);
    const double depth = random.uniform(0.15, 0.4), width = random.uniform(0.15, 0.5);
    solid.add(prism(rectangle(width, depth, shape, 0.05), height, at({u, v, 0}), rim, 0.04));
  }
  add_bush(scene, random, {0.6 * x, 0.6 * y, 0.9}, 0.3);
  scene.scanners = {{{0.1, -0.1, 1.5}, {0, 0, 1.4}},
                    {{-0.6 * x, -0.6 * y, 1.5}, {0, 0, 1.4}},
                    {{0.6 * x, -0.5 * y, 1.5}, {0, 0, 1.4}}};
  return scene;
}

Scene monument(Random& random) {
  Scene scene;
  add_ground(scene, random);
  Solid& solid = scene.solid;
  const int steps = 2 + static_cast<int>(random.index(4));
  double top = 0.0, half = random.uniform(1.5, 2.2);
  for (int i = 0; i < steps; ++i, half -= 0.25) {
    const CornerShape rim = any_shape(random);
    solid.add(prism(rectangle(half, half, any_shape(random), 0.1), 0.1, at({0, 1, top + 0.1}), rim,
                    0.03));
    top += 0.2;
  }
  if (chance(random, 0.5)) {  // columns carry a slab
    for (int i = 0; i < 4; ++i) {
      const Vec3 foot((i % 2 ? 0.6 : -0.6) * half, 1 + (i / 2 ? 0.6 : -0.6) * half, top + 0.9);
      const double radius = random.uniform(0.1, 0.22);
      solid.add(cylinder(radius, 0.9, at(foot)));
      solid.add(box(1.3 * radius, 1.3 * radius, 0.06, foot - Vec3(0, 0, 0.85)));
      solid.add(
          cylinder(1.3 * radius, 0.06, at(foot + Vec3(0, 0, 0.85)), CornerShape::kFillet, 0.05));
    }
    solid.add(box(half, half, 0.15, {0, 1, top + 1.95}));
    solid.add(prism(outline({{{-half, 0}}, {{half, 0}}, {{0, random.uniform(0.4, 0.9)}}}), half,
                    along(1, {0, 1, top + 2.1})));
  } else {  // an obelisk or a statue's block
    const double wide = random.uniform(0.3, 0.7) * half;
    solid.add(box(wide, wide, 0.5, {0, 1, top + 0.5}));
    solid.add(box(1.15 * wide, 1.15 * wide, 0.06, {0, 1, top + 1.0}));
    solid.add(
        turned(outline({{{-0.6, top + 1}},
                        {{0.8 * wide, top + 1}, CornerShape::kFillet, 0.1},
                        {{random.uniform(0.2, 0.7) * wide, top + 1.6}, CornerShape::kFillet, 0.2},
                        {{random.uniform(0.2, 0.9) * wide, top + 2.4}, any_shape(random), 0.2},
                        {{-0.6, top + 2.6}}}),
               at({0, 1, 0})));
  }
  for (int i = 0; i < 3; ++i) {
    const double radius = random.uniform(0.2, 0.6);
    add_bush(scene, random, {random.uniform(-4, 4), random.uniform(-1, 3), 0.4}, radius);
  }
  scene.scanners = {{{random.uniform(-2, 2), -4, 1.7}, {0, 1, 1.2}},
                    {{4, 0, 1.7}, {0, 1, 1.2}},
                    {{-4, 3, 1.7}, {0, 1, 1.2}}};
  return scene;
}

struct SceneKind {
  const char* name;
  Scene (*make)(Random& random);
};

constexpr std::array<SceneKind, kSceneKinds> kScenes = {
    {{"facade", facade}, {"yard", yard}, {"room", room}, {"monument", monument}}};

}  // namespace

const char* scene_kind_name(int kind) {
  return kScenes.at(static_cast<std::size_t>(kind)).name;
}

Scene random_scene(int kind, Random& random) {
  return kScenes.at(static_cast<std::size_t>(kind)).make(random);
}

}  // namespace pcednet::shapes
