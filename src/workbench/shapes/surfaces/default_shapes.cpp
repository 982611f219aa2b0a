#include "workbench/shapes/surfaces/default_shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "workbench/shapes/surfaces/patches.h"
#include "workbench/shapes/surfaces/polyhedra.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {
namespace {

Eigen::Isometry3d shifted(const Vec3& shift) {
  return Eigen::Isometry3d(Eigen::Translation3d(shift));
}

/// A sheet z = sign * s * |q|, a crease where q = 0, with s falling linearly from `slope` at `from`
/// to 0 at `to` along x.
HeightField fading(const std::function<double(double, double)>& q,
                   const std::function<Vec2(double, double)>& q_gradient, double slope, double from,
                   double to, double sign) {
  const double rate = slope / (to - from);
  const auto s = [=](double x) { return rate * (to - x); };
  HeightField field;
  field.height = [=](double x, double y) { return sign * s(x) * std::abs(q(x, y)); };
  field.gradient = [=](double x, double y) -> Vec2 {
    const double side = q(x, y) < 0.0 ? -1.0 : 1.0;
    return sign * (side * s(x) * q_gradient(x, y) - Vec2(rate * std::abs(q(x, y)), 0.0));
  };
  field.max_slope = 4.0 * slope;
  return field;
}

/// Adds chords along the crease curve z = 0, (x, y) = curve(t), t in [0, 1], of `field`; `across`
/// is a horizontal direction that crosses it at t.
void add_crease(Shape& shape, const HeightField& field, const std::function<Vec2(double)>& curve,
                const std::function<Vec2(double)>& across) {
  constexpr int kChords = 192;
  constexpr double kAside = 1e-6;
  const auto normal_at = [&](const Vec2& p) {
    const Vec2 g = field.gradient(p.x(), p.y());
    return Vec3(-g.x(), -g.y(), 1.0).normalized();
  };
  for (int i = 0; i < kChords; ++i) {
    const double middle = (i + 0.5) / kChords;
    const Vec2 aside = kAside * across(middle);
    const EdgeClass strength =
        crease_strength(normal_at(curve(middle) - aside), normal_at(curve(middle) + aside));
    if (strength == kNonEdge) continue;
    const Vec2 a = curve(static_cast<double>(i) / kChords);
    const Vec2 b = curve(static_cast<double>(i + 1) / kChords);
    shape.edges.push_back({Segment{Vec3(a.x(), a.y(), 0.0), Vec3(b.x(), b.y(), 0.0)}, strength});
  }
}

Shape straight_crease(double slope, double sign) {
  const HeightField field =
      fading([](double, double y) { return y; }, [](double, double) { return Vec2(0.0, 1.0); },
             slope, 0.0, 3.0, sign);
  Shape shape;
  shape.patches.push_back(graph(field, Vec2(0.0, -0.8), Vec2(3.0, 0.8)));
  add_crease(
      shape, field, [](double t) { return Vec2(3.0 * t, 0.0); },
      [](double) { return Vec2(0.0, 1.0); });
  return shape;
}

/// q = (r^2 - 1) / 2: the crease is the unit circle.
Shape ring_crease(double slope, double sign) {
  const HeightField field =
      fading([](double x, double y) { return 0.5 * (x * x + y * y - 1.0); },
             [](double x, double y) { return Vec2(x, y); }, slope, -1.5, 1.5, sign);
  const auto circle_at = [](double t) {
    return Vec2(std::cos(2.0 * std::numbers::pi * t), std::sin(2.0 * std::numbers::pi * t));
  };
  Shape shape;
  shape.patches.push_back(graph(field, Vec2(-1.5, -1.5), Vec2(1.5, 1.5)));
  add_crease(shape, field, circle_at, circle_at);
  return shape;
}

bool on_plane(const EdgeCurve& edge, int axis, double value) {
  const Segment& segment = std::get<Segment>(edge.curve);
  return segment.a[axis] == value && segment.b[axis] == value;
}

/// Removes what lies in an axis plane: patches, and the edges, which become rims.
void remove_plane(Shape& shape, int axis, double value) {
  std::erase_if(shape.patches, [&](const SurfacePatch& patch) {
    const SurfacePoint middle = patch.at(0.5, 0.5);
    return middle.position[axis] == value && std::abs(middle.normal[axis]) == 1.0;
  });
  std::erase_if(shape.edges, [&](const EdgeCurve& edge) {
    if (!on_plane(edge, axis, value)) return false;
    shape.rims.push_back(std::get<Segment>(edge.curve));
    return true;
  });
}

}  // namespace

Shape cone_on_plate() {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Shape shape;
  shape.patches = {
      revolved_line({0.0, 0.0}, {1.0, 0.0}, kTurn), revolved_line({1.0, 0.0}, {1.0, 0.3}, kTurn),
      revolved_line({1.0, 0.3}, {0.5, 0.3}, kTurn), revolved_line({0.5, 0.3}, {0.0, 2.0}, kTurn)};
  const Vec3 apex(0.0, 0.0, 2.0);
  shape.edges = {circle(1.0, 0.0), circle(1.0, 0.3), circle(0.5, 0.3), {Segment{apex, apex}}};
  return shape;
}

Shape fan_part() {
  // Corner 3 (a chamfer) and corner 6 (a bead) come to lie on the line of their neighbours.
  const std::vector<Vec2> first = {{1.0, 0.0},  {2.0, 0.0},  {2.0, 0.5},  {1.8, 0.9},  {1.65, 0.9},
                                   {1.6, 1.25}, {1.45, 1.4}, {1.3, 1.25}, {1.25, 0.9}, {1.0, 0.9}};
  std::vector<Vec2> last = first;
  last[3] = {1.825, 0.7};
  last[6] = {1.45, 1.25};
  return make_shape(Loft{first, last, 0.6 * std::numbers::pi});
}

Shape four_cubes() {
  const std::array<Vec3, 4> lows = {Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.3),
                                    Vec3(0.35, -0.3, 1.0)};
  std::vector<Box> boxes;
  for (const Vec3& low : lows) boxes.push_back({low, low + Vec3::Ones()});
  return make_shape(boxes);
}

Shape random_blocks(Random& random) {
  constexpr double kGrid = 0.125;
  std::vector<Box> boxes = {{Vec3::Zero(), Vec3::Ones()}};
  const std::size_t count = 3 + random.index(3);
  while (boxes.size() < count) {
    Vec3 low;
    Vec3 size;
    for (int axis = 0; axis < 3; ++axis) {
      size[axis] = kGrid * static_cast<double>(3 + random.index(5));
      low[axis] = kGrid * (static_cast<double>(random.index(11)) - 3.0);
    }
    boxes.push_back({low, low + size, random.index(3) != 0});
  }
  return make_shape(boxes);
}

Shape wedges() {
  Shape shape;
  for (int i = 0; i < 7; ++i) {
    const double dihedral = (60.0 + 15.0 * i) * std::numbers::pi / 180.0;
    const Vec3 edge = (i % 2 ? -1.0 : 1.0) * Vec3::UnitY();
    const Vec3 side(std::cos(dihedral), 0.0, std::sin(dihedral));
    Shape wedge;
    wedge.patches = {parallelogram(-0.5 * edge, edge, Vec3::UnitX()),
                     parallelogram(-0.5 * edge, 0.8 * side, edge)};
    wedge.edges = {{Segment{-0.5 * edge, 0.5 * edge}}};
    add_rims(wedge);
    const int column = i % 3, row = i / 3;
    append(shape, wedge, shifted(Vec3(2.0 * column, 1.5 * row, 0.2 * i)));
  }
  return shape;
}

Shape open_sheets() {
  const HeightField waves{
      [](double x, double y) { return 0.15 * std::sin(2.0 * x) * std::cos(1.5 * y); },
      [](double x, double y) {
        return Vec2(0.3 * std::cos(2.0 * x) * std::cos(1.5 * y),
                    -0.225 * std::sin(2.0 * x) * std::sin(1.5 * y));
      },
      0.4};
  Shape flat;
  flat.patches = {parallelogram(Vec3::Zero(), Vec3(2.0, 0.0, 0.0), Vec3(0.3, 1.2, 0.0)),
                  triangle(Vec3(0, 0, 0.6), Vec3(1.5, 0.2, 0.8), Vec3(0.4, 1.3, 0.7)),
                  triangle(Vec3(0, 2.0, 0.0), Vec3(1.5, 2.2, 0.3), Vec3(0.2, 3.3, 0.5))};
  Shape bent;
  bent.patches = {revolved_arc({1.5, 0.3}, 0.4, -1.2, 1.0, 0.5 * std::numbers::pi)};
  Shape shape;
  shape.patches = {graph(waves, Vec2(-1.5, -1.0), Vec2(1.5, 1.0))};
  append(shape, flat, shifted(Vec3(2.2, 0.0, 0.0)));
  append(shape, bent, shifted(Vec3(-1.0, 1.5, 0.0)));
  add_rims(shape);
  return shape;
}

Shape fading_creases() {
  Shape shape;
  append(shape, straight_crease(1.0, 1.0));
  append(shape, straight_crease(0.7, -1.0), shifted(Vec3(0.0, 2.0, 0.0)));
  append(shape, ring_crease(0.6, 1.0), shifted(Vec3(5.0, 0.0, 0.0)));
  append(shape, ring_crease(0.6, -1.0), shifted(Vec3(5.0, 3.5, 0.0)));
  add_rims(shape);
  return shape;
}

Shape rounded_box(double radius) {
  const Vec3 half(0.5, 0.6, 0.45);
  const Vec3 inner = half - Vec3::Constant(radius);
  Shape octant;
  Shape ball;
  ball.patches = {
      revolved_arc({0.0, 0.0}, radius, 0.0, 0.5 * std::numbers::pi, 0.5 * std::numbers::pi)};
  append(octant, ball, shifted(inner));
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 e = Vec3::Unit(axis);
    const Vec3 x = Vec3::Unit((axis + 1) % 3);
    const Vec3 y = Vec3::Unit((axis + 2) % 3);
    const Vec3& end = inner;
    const Vec3 start = inner - inner[axis] * e;
    octant.patches.push_back(cylinder_strip(start, end, x, radius, 0.5 * std::numbers::pi));
    octant.patches.push_back(parallelogram(half[axis] * e, inner.dot(x) * x, inner.dot(y) * y));
    const Vec3 middle = radius * (x + y) / std::numbers::sqrt2;
    octant.edges.push_back({Segment{start + middle, end + middle}, kSmoothEdge});
  }
  Shape shape;
  for (int i = 0; i < 8; ++i) {
    Eigen::Isometry3d mirror = Eigen::Isometry3d::Identity();
    mirror.linear() = Vec3(i & 1 ? -1 : 1, i & 2 ? -1 : 1, i & 4 ? -1 : 1).asDiagonal();
    append(shape, octant, mirror);
  }
  return shape;
}

Shape round_solids() {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Shape ball;
  ball.patches = {
      revolved_arc({0.0, 0.0}, 0.6, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi, kTurn)};
  Shape shape;
  shape.patches = {revolved_line({0.0, 0.0}, {0.5, 0.0}, kTurn),
                   revolved_line({0.5, 0.0}, {0.5, 1.4}, kTurn),
                   revolved_line({0.5, 1.4}, {0.0, 1.4}, kTurn)};
  shape.edges = {circle(0.5, 0.0), circle(0.5, 1.4)};
  append(shape, ball, shifted(Vec3(1.6, 0.3, 0.6)));
  return shape;
}

Shape wall_front(Random& random) {
  constexpr double kWidth = 3.0;
  constexpr double kHeight = 3.0;
  const double recess = random.uniform(0.1, 0.25);
  const double relief = random.uniform(0.06, 0.15);
  // The street is at negative y.
  std::vector<Box> boxes = {{Vec3(0.0, 0.0, 0.0), Vec3(kWidth, 1.0, kHeight)},
                            {Vec3(0.0, -relief, 1.45), Vec3(kWidth, 0.0, 1.55)},
                            {Vec3(0.0, -2.0 * relief, 2.75), Vec3(kWidth, 0.0, kHeight)}};
  const double width = random.uniform(0.7, 0.85);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const double x = 0.4 + 1.4 * column + random.uniform(-0.05, 0.05);
      const double z = row == 0 ? 0.45 : 1.8;
      const bool door = row == 0 && column == 1;
      boxes.push_back({Vec3(x, 0.0, door ? 0.0 : z), Vec3(x + width, recess, z + 0.75), false});
      if (door) {
        boxes.push_back({Vec3(x - 0.1, -0.3, 0.0), Vec3(x + width + 0.1, 0.0, 0.08)});
        boxes.push_back({Vec3(x - 0.1, -0.15, 0.08), Vec3(x + width + 0.1, 0.0, 0.16)});
      } else {
        boxes.push_back({Vec3(x - 0.06, -relief, z - 0.08), Vec3(x + width + 0.06, 0.0, z)});
      }
    }
  }
  Shape shape = make_shape(boxes);
  remove_plane(shape, 1, 1.0);
  for (const double x : {0.0, kWidth}) remove_plane(shape, 0, x);
  for (const double z : {0.0, kHeight}) remove_plane(shape, 2, z);
  return shape;
}

}  // namespace pcednet::shapes
