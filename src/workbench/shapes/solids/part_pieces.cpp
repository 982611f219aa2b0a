#include "workbench/shapes/solids/part_pieces.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "pcednet/core/random_vectors.h"

namespace pcednet::shapes {

Eigen::Isometry3d at(const Vec3& place) {
  return Eigen::Isometry3d(Eigen::Translation3d(place));
}

Eigen::Isometry3d along(int axis, const Vec3& place) {
  Eigen::Isometry3d frame = at(place);
  if (axis == 0) frame.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()));
  if (axis == 1) frame.rotate(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vec3::UnitX()));
  return frame;
}

bool chance(Random& random, double p) {
  return random.uniform() < p;
}

double size_between(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

std::size_t points_between(Random& random, double low, double high) {
  return static_cast<std::size_t>(size_between(random, low, high));
}

Vec3 any_direction(Random& random) {
  return normal_vector(random).normalized();
}

CornerShape any_shape(Random& random) {
  const std::size_t i = random.index(4);
  return i < 2 ? CornerShape::kSharp : i == 2 ? CornerShape::kFillet : CornerShape::kChamfer;
}

Profile rectangle(double x, double y, CornerShape shape, double size) {
  return outline({{{-x, -y}, shape, size},
                  {{x, -y}, shape, size},
                  {{x, y}, shape, size},
                  {{-x, y}, shape, size}});
}

Profile regular_polygon(int corners, double radius, double phase) {
  std::vector<Corner> list;
  for (int i = 0; i < corners; ++i) {
    const double t = phase + 2.0 * std::numbers::pi * i / corners;
    list.push_back({radius * Vec2(std::cos(t), std::sin(t))});
  }
  return outline(list);
}

Volume prism(Profile profile, double half_height, const Eigen::Isometry3d& frame, CornerShape rim,
             double rim_size) {
  return {Volume::Kind::kPrism, std::move(profile), half_height, rim, rim_size, frame};
}

Volume turned(Profile profile, const Eigen::Isometry3d& frame) {
  return {Volume::Kind::kRevolution, std::move(profile), 1.0, CornerShape::kSharp, 0.0, frame};
}

Volume cylinder(double radius, double half_height, const Eigen::Isometry3d& frame, CornerShape rim,
                double rim_size) {
  return prism(circle_profile(Vec2::Zero(), radius), half_height, frame, rim, rim_size);
}

Volume box(double x, double y, double z, const Vec3& place) {
  return prism(rectangle(x, y), z, at(place));
}

Profile random_outline(Random& random, double radius) {
  const int corners = 4 + static_cast<int>(random.index(6));
  std::vector<Corner> list;
  for (int i = 0; i < corners; ++i) {
    const double t = 2.0 * std::numbers::pi * (i + 0.35 * random.uniform(-1, 1)) / corners;
    list.push_back({radius * random.uniform(0.55, 1.0) * Vec2(std::cos(t), std::sin(t)),
                    any_shape(random), size_between(random, 0.02, 0.25) * radius});
  }
  return outline(list);
}

void drill(Solid& part, Random& random, const Vec2& place, double radius, double top,
           double depth) {
  const Eigen::Isometry3d frame = at({place.x(), place.y(), top - 0.5 * depth + 0.5});
  const double half = 0.5 * depth + 0.5;
  switch (random.index(6)) {
    case 0: {
      const CornerShape shape = any_shape(random);
      const double width = radius * random.uniform(0.5, 1.0);
      part.cut(prism(rectangle(radius, width, shape, 0.4 * radius), half, frame));
      break;
    }
    case 1: {
      const double t = random.uniform(0.0, std::numbers::pi);
      const Vec2 reach = radius * random.uniform(0.5, 1.5) * Vec2(std::cos(t), std::sin(t));
      part.cut(prism(slot_profile(-reach, reach, 0.6 * radius), half, frame));
      break;
    }
    case 2:  // countersunk
      part.cut(cylinder(0.6 * radius, half, frame));
      part.cut(turned(outline({{{-0.6, top - 0.4 * radius}},
                               {{0.6 * radius, top - 0.4 * radius}},
                               {{1.2 * radius, top + 0.2 * radius}},
                               {{-0.6, top + 0.2 * radius}}}),
                      at({place.x(), place.y(), 0.0})));
      break;
    case 3:  // counterbored
      part.cut(cylinder(0.55 * radius, half, frame));
      part.cut(cylinder(radius, 0.5,
                        at({place.x(), place.y(), top + 0.5 - random.uniform(0.2, 0.6) * depth})));
      break;
    case 4:
      part.cut(prism(regular_polygon(6, radius, random.uniform(0, std::numbers::pi)), half, frame));
      break;
    default:
      part.cut(cylinder(radius, half, frame));
  }
}

}  // namespace pcednet::shapes
