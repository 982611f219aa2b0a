#include "workbench/shapes/solids/turned_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "workbench/shapes/solids/part_pieces.h"

namespace pcednet::shapes {

Solid shaft(Random& random) {
  const int steps = 2 + static_cast<int>(random.index(5));
  std::vector<Corner> corners = {{{-0.6, -0.5}}};
  double z = -0.5;
  double radius = random.uniform(0.05, 0.25);
  for (int i = 0; i < steps; ++i) {
    const double next =
        i + 1 == steps ? 0.5 : z + random.uniform(0.5, 1.5) * (0.5 - z) / (steps - i);
    corners.push_back({{radius, z}, any_shape(random), size_between(random, 0.005, 0.05)});
    const double taper = chance(random, 0.25) ? random.uniform(0.7, 1.2) : 1.0;
    corners.push_back({{radius * taper, std::min(next, 0.5)},
                       any_shape(random),
                       size_between(random, 0.005, 0.05)});
    z = std::min(next, 0.5);
    radius = random.uniform(0.04, 0.3);
    if (z >= 0.5) break;
  }
  corners.push_back({{-0.6, 0.5}});
  Solid part;
  part.add(turned(outline(corners), at(Vec3::Zero())));
  if (chance(random, 0.5)) {
    const double height = random.uniform(-0.4, 0.4);
    part.cut(cylinder(size_between(random, 0.01, 0.04), 0.6, along(0, {0, 0, height})));
  }
  if (chance(random, 0.4)) {
    const double depth = chance(random, 0.5) ? 0.6 : 0.2;
    part.cut(cylinder(random.uniform(0.01, 0.035), depth, at({0, 0, 0.4})));
  }
  if (chance(random, 0.4))
    part.cut(box(0.3, 0.3, 0.1, {random.uniform(0.31, 0.36), 0, random.uniform(-0.4, 0.4)}));
  if (chance(random, 0.3))
    part.cut(prism(slot_profile({-0.08, 0}, {0.08, 0}, 0.015), 0.1, along(0, {0.12, 0, 0.1})));
  return part;
}

Solid flange(Random& random) {
  const double radius = random.uniform(0.35, 0.5), thick = size_between(random, 0.02, 0.08);
  const double hub = random.uniform(0.3, 0.6) * radius, tall = random.uniform(0.1, 0.5);
  const double bore = random.uniform(0.4, 0.85) * hub;
  const double fillet = random.uniform(0.2, 1.0) * thick;
  Solid part;
  part.add(turned(
      outline(
          {{{bore, 0}, any_shape(random), 0.2 * thick},
           {{radius, 0}, any_shape(random), 0.3 * thick},
           {{radius, thick}, any_shape(random), 0.3 * thick},
           {{hub, thick}, any_shape(random), fillet},
           {{hub * random.uniform(0.9, 1.0), tall + thick}, any_shape(random), 0.2 * (hub - bore)},
           {{bore, tall + thick}, any_shape(random), 0.2 * (hub - bore)}}),
      at(Vec3::Zero())));
  const int bolts = 3 + static_cast<int>(random.index(8));
  const double circle = 0.5 * (hub + radius) + 0.3 * fillet,
               bolt = random.uniform(0.15, 0.35) * (radius - hub);
  for (int i = 0; i < bolts; ++i) {
    const double t = 2.0 * std::numbers::pi * i / bolts;
    part.cut(cylinder(bolt, 1.0, at({circle * std::cos(t), circle * std::sin(t), 0})));
  }
  if (chance(random, 0.4)) part.cut(box(0.04, 0.04, 1.0, {bore, 0, 0}));
  return part;
}

Solid gear(Random& random) {
  const int teeth = 8 + static_cast<int>(random.index(20));
  const double outer = 0.5, root = outer * random.uniform(0.75, 0.9);
  const double flank = random.uniform(0.1, 0.35), tip = random.uniform(0.15, 0.35);
  const CornerShape shape = any_shape(random);
  std::vector<Corner> corners;
  const auto add = [&](double r, double t) {
    corners.push_back({r * Vec2(std::cos(t), std::sin(t)), shape, 0.01});
  };
  for (int i = 0; i < teeth; ++i) {
    const double step = 2.0 * std::numbers::pi / teeth, t = i * step;
    add(root, t), add(outer, t + flank * step), add(outer, t + (flank + tip) * step);
    add(root, t + std::min(0.95, 2.0 * flank + tip) * step);
  }
  const double z = random.uniform(0.04, 0.2);
  Solid part;
  part.add(prism(outline(corners), z, at(Vec3::Zero()),
                 chance(random, 0.3) ? CornerShape::kChamfer : CornerShape::kSharp, 0.1 * z));
  const double bore = random.uniform(0.1, 0.3);
  part.cut(cylinder(bore, 1.0, at(Vec3::Zero())));
  if (chance(random, 0.6)) part.cut(box(0.2 * bore, 0.2 * bore, 1.0, {bore, 0, 0}));
  if (chance(random, 0.5)) {
    const int windows = 3 + static_cast<int>(random.index(5));
    const double r = 0.5 * (bore + root);
    for (int i = 0; i < windows; ++i) {
      const double t = 2.0 * std::numbers::pi * i / windows;
      part.cut(cylinder(0.3 * (root - bore), 1.0, at({r * std::cos(t), r * std::sin(t), 0})));
    }
  }
  return part;
}

Solid ring(Random& random) {
  const double radius = random.uniform(0.25, 0.4), tube = size_between(random, 0.02, 0.1);
  Solid part;
  switch (random.index(4)) {
    case 0:
      part.add(turned(circle_profile({radius, 0}, tube), at(Vec3::Zero())));
      break;
    case 1:
      part.add(turned(outline({{{radius - tube, -tube}, any_shape(random), 0.5 * tube},
                               {{radius + tube, -tube}, any_shape(random), 0.5 * tube},
                               {{radius + tube, tube}, any_shape(random), 0.5 * tube},
                               {{radius - tube, tube}, any_shape(random), 0.5 * tube}}),
                      at(Vec3::Zero())));
      break;
    case 2:
      part.add(turned(outline({{{radius - 0.4 * tube, -3 * tube}},
                               {{radius, -3 * tube}},
                               {{radius + tube, 3 * tube}, any_shape(random), 0.2 * tube},
                               {{radius + 0.6 * tube, 3 * tube}}}),
                      at(Vec3::Zero())));
      break;
    default:  // with a groove
      part.add(turned(outline({{{radius - tube, -tube}},
                               {{radius + tube, -tube}},
                               {{radius + tube, tube}},
                               {{radius - tube, tube}}}),
                      at(Vec3::Zero())));
      part.cut(turned(circle_profile({radius + tube, 0}, random.uniform(0.3, 0.8) * tube),
                      at(Vec3::Zero())));
  }
  if (chance(random, 0.4)) part.cut(box(1.0, random.uniform(0.02, 0.3) * radius, 1.0, {0.8, 0, 0}));
  if (chance(random, 0.3)) part.add(cylinder(0.4 * tube, radius, along(0, Vec3::Zero())));
  return part;
}

Solid dome(Random& random) {
  const double radius = random.uniform(0.25, 0.5);
  Solid part;
  std::vector<Corner> corners = {{{-0.6, 0}},
                                 {{radius, 0}, any_shape(random), 0.03},
                                 {{radius, random.uniform(0.05, 0.2)}, CornerShape::kFillet, 0.15},
                                 {{random.uniform(0.3, 0.8) * radius, random.uniform(0.25, 0.45)},
                                  CornerShape::kFillet,
                                  random.uniform(0.05, 0.3)},
                                 {{-0.6, random.uniform(0.45, 0.6)}}};
  part.add(turned(outline(corners), at(Vec3::Zero())));
  if (chance(random, 0.5)) {
    const double aside = random.uniform(-0.2, 0.2);
    part.add(turned(circle_profile({0, 0.4}, random.uniform(0.08, 0.2)), at({aside, 0, 0})));
  }
  if (chance(random, 0.6)) {
    const double bore = random.uniform(0.03, 0.1);
    drill(part, random, {random.uniform(-0.4, 0.4) * radius, random.uniform(-0.4, 0.4) * radius},
          bore, 0.6, 0.4);
  }
  if (chance(random, 0.4)) part.cut(box(0.3, 1.0, 1.0, {random.uniform(0.45, 0.6), 0, 0}));
  return part;
}

Solid knob(Random& random) {
  Solid part;
  const int grips = 4 + static_cast<int>(random.index(8));
  const double radius = random.uniform(0.3, 0.5), z = random.uniform(0.08, 0.25);
  const double rim_size = random.uniform(0.1, 0.6) * z;
  part.add(cylinder(radius, z, at(Vec3::Zero()), any_shape(random), rim_size));
  const double grip = random.uniform(0.3, 0.9) * std::numbers::pi * radius / grips,
               out = radius + random.uniform(0.0, 0.7) * grip;
  for (int i = 0; i < grips; ++i) {
    const double t = 2.0 * std::numbers::pi * i / grips;
    part.cut(cylinder(grip, 1.0, at({out * std::cos(t), out * std::sin(t), 0})));
  }
  const CornerShape rim = any_shape(random);
  part.add(
      cylinder(random.uniform(0.3, 0.5) * radius, 0.5 * z, at({0, 0, -1.3 * z}), rim, 0.1 * z));
  if (chance(random, 0.7))
    drill(part, random, Vec2::Zero(), 0.2 * radius, z, random.uniform(0.5, 4.0) * z);
  return part;
}

}  // namespace pcednet::shapes
