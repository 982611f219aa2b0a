#include "workbench/shapes/relief.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "pcednet/core/random.h"
#include "workbench/shapes/surfaces/patches.h"
#include "workbench/shapes/surfaces/shape.h"
#include "workbench/shapes/wear.h"

namespace pcednet::shapes {
namespace {

using std::numbers::pi;

/// A distance in the plane, negative inside the ornament; of a crest, to the line itself.
using Field = std::function<double(const Vec2&)>;

/// A raised or sunken shape along a field.
struct Ornament {
  enum class Flank { kPlateau, kDome, kCrest } flank = Flank::kPlateau;
  Field field;
  double height = 0.05;  ///< negative: sunken
  double width = 0.02;   ///< of the flank

  double at(const Vec2& p) const {
    const double d = field(p);
    if (flank == Flank::kCrest) return height * std::exp(-0.5 * (d / width) * (d / width));
    const double inside = std::clamp(-d / width, 0.0, 1.0);
    if (flank == Flank::kDome) return height * std::sqrt(inside * (2.0 - inside));
    return height * inside;
  }

  /// The values of the field along which a line is visible.
  std::vector<double> lines() const {
    if (flank == Flank::kPlateau) return {0.0, -width};
    return {0.0};
  }
};

double to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm();
}

Field stroke(std::vector<Vec2> path, double half_width) {
  return [path = std::move(path), half_width](const Vec2& p) {
    double nearest = 1e9;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      nearest = std::min(nearest, to_segment(p, path[i], path[i + 1]));
    }
    return nearest - half_width;
  };
}

Field rounded_box(const Vec2& centre, const Vec2& half, double radius) {
  return [=](const Vec2& p) {
    const Vec2 q = (p - centre).cwiseAbs() - half + Vec2(radius, radius);
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - radius;
  };
}

/// Distance to an ellipse, good near it.
Field ellipse(const Vec2& centre, const Vec2& half, double turn) {
  const Eigen::Rotation2Dd back(-turn);
  return [=](const Vec2& p) {
    const Vec2 q = back * (p - centre);
    const double k = q.cwiseQuotient(half).norm();
    const double g = q.cwiseQuotient(half.cwiseAbs2()).norm();
    return g > 1e-9 ? k * (k - 1.0) / g : -half.minCoeff();
  };
}

Field any_of(std::vector<Field> fields) {
  return [fields = std::move(fields)](const Vec2& p) {
    double nearest = 1e9;
    for (const Field& field : fields) nearest = std::min(nearest, field(p));
    return nearest;
  };
}

Field grid_of_buttons(Random& random, const Vec2& half) {
  std::vector<Field> fields;
  const double pitch = random.uniform(0.15, 0.4), size = pitch * random.uniform(0.25, 0.42);
  for (double x = -half.x() + pitch / 2; x < half.x(); x += pitch) {
    const bool round = random.index(2) == 0;
    for (double y = -half.y() + pitch / 2; y < half.y(); y += pitch) {
      if (random.index(8) == 0) continue;
      const Vec2 sides(size, round ? size : size * random.uniform(0.3, 0.9));
      fields.push_back(round ? ellipse({x, y}, sides, 0.0)
                             : rounded_box({x, y}, sides, 0.3 * sides.y()));
    }
  }
  return any_of(std::move(fields));
}

std::vector<Vec2> meander(Random& random, double half_length) {
  const double unit = random.uniform(0.03, 0.09);
  // A key turns inwards and out again; each is six units long.
  const Vec2 steps[] = {{0, 5}, {5, 0},  {0, -3}, {-2, 0}, {0, 1}, {1, 0},
                        {0, 1}, {-3, 0}, {0, -3}, {5, 0},  {0, -1}};
  std::vector<Vec2> path = {Vec2(-half_length, -2.5 * unit)};
  while (path.back().x() < half_length) {
    for (const Vec2& step : steps) path.push_back(path.back() + unit * step);
  }
  return path;
}

std::vector<Vec2> spiral(Random& random) {
  const double turns = random.uniform(1.5, 3.5), growth = 0.42 / (2 * pi * turns);
  std::vector<Vec2> path;
  for (int i = 0; i <= 60 * turns; ++i) {
    const double angle = 2 * pi * i / 60.0;
    path.push_back((0.02 + growth * angle) * Vec2(std::cos(angle), std::sin(angle)));
  }
  path.push_back(path.back() + Vec2(0.0, random.uniform(0.2, 0.6)));
  return path;
}

std::vector<Vec2> strokes_of_a_sign(Random& random, const Vec2& half) {
  std::vector<Vec2> path = {Vec2::Zero()};
  for (int i = 0; i < 14; ++i) {
    const double angle = random.uniform(-pi, pi);
    const Vec2 next =
        path.back() + random.uniform(0.1, 0.4) * Vec2(std::cos(angle), std::sin(angle));
    path.push_back(next.cwiseMax(-0.85 * half).cwiseMin(0.85 * half));
  }
  return path;
}

Ornament with_flank(Random& random, Field field) {
  Ornament ornament;
  ornament.field = std::move(field);
  const double height = random.uniform(0.015, 0.08);
  ornament.height = random.index(3) == 0 ? -height : height;
  ornament.width = height * random.uniform(0.3, 1.2);
  return ornament;
}

Ornament dome(Random& random, Field field) {
  Ornament ornament = with_flank(random, std::move(field));
  ornament.flank = Ornament::Flank::kDome;
  ornament.width = std::abs(ornament.height) * random.uniform(0.8, 2.0);
  return ornament;
}

Ornament crest(Random& random, Field line) {
  Ornament ornament;
  ornament.flank = Ornament::Flank::kCrest;
  ornament.field = std::move(line);
  ornament.height = (random.index(3) ? 1 : -1) * random.uniform(0.01, 0.06);
  ornament.width = std::abs(ornament.height) * random.uniform(0.35, 1.2);
  return ornament;
}

std::vector<Ornament> nested_rings(Random& random, const Vec2& half) {
  std::vector<Ornament> ornaments;
  const Vec2 centre{random.uniform(-0.3, 0.3) * half.x(), 0.0};
  const double turn = random.uniform(0.0, pi), flat = random.uniform(0.4, 1.0);
  const double height = random.uniform(0.015, 0.05), width = height * random.uniform(0.35, 1.0);
  for (double size = random.uniform(0.08, 0.16); size < 0.8 * half.y();
       size += std::max(5.0 * width, random.uniform(0.07, 0.2))) {
    Ornament ring = crest(random, ellipse(centre, Vec2(size, flat * size), turn));
    ring.height = height;
    ring.width = width;
    ornaments.push_back(std::move(ring));
  }
  return ornaments;
}

std::vector<Ornament> flutes(Random& random) {
  const double pitch = random.uniform(0.1, 0.25), slant = random.uniform(-0.5, 0.5);
  const double wobble = random.uniform(0.0, 0.05);
  return {crest(random, [=](const Vec2& p) {
    const double x = p.x() + slant * p.y() + wobble * std::sin(9.0 * p.y());
    return x - pitch * std::round(x / pitch);
  })};
}

std::vector<Ornament> terraces(Random& random) {
  std::vector<Ornament> ornaments;
  const Vec2 centre{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)};
  const double flat = random.uniform(0.5, 1.0), turn = random.uniform(0.0, pi);
  for (double size = random.uniform(0.1, 0.2); size < 0.6; size += random.uniform(0.1, 0.2)) {
    Ornament step = with_flank(random, ellipse(centre, Vec2(size, flat * size), turn));
    step.height = std::abs(step.height);
    ornaments.push_back(std::move(step));
  }
  return ornaments;
}

Ornament drawn_line(Random& random, std::vector<Vec2> path, double thinnest, double thickest) {
  return with_flank(random, stroke(std::move(path), random.uniform(thinnest, thickest)));
}

std::vector<Ornament> random_ornaments(Random& random, const Vec2& half) {
  switch (random.index(8)) {
    case 0:
      return {with_flank(random, grid_of_buttons(random, half))};
    case 1:
      return {dome(random, grid_of_buttons(random, half))};
    case 2:
      return {drawn_line(random, meander(random, half.x()), 0.008, 0.025)};
    case 3:
      return {drawn_line(random, spiral(random), 0.015, 0.04)};
    case 4:
      return {drawn_line(random, strokes_of_a_sign(random, half), 0.01, 0.05)};
    case 5:
      return nested_rings(random, half);
    case 6:
      return flutes(random);
    default:
      return terraces(random);
  }
}

/// The plate itself: bent one or two ways, with shallow waves.
Field relief_plate(Random& random) {
  const double bend = random.uniform(-0.8, 0.8), twist = random.uniform(-0.4, 0.4);
  const double other = random.index(2) ? random.uniform(-0.8, 0.8) : 0.0;
  const double wave = random.uniform(0.0, 0.02), phase = random.uniform(0.0, 2 * pi);
  const double length = random.uniform(4.0, 12.0);
  return [=](const Vec2& p) {
    return bend * p.x() * p.x() + other * p.y() * p.y() + twist * p.x() * p.y() +
           wave * std::sin(length * p.x() + phase) * std::cos(length * p.y());
  };
}

Vec2 gradient(const Field& field, const Vec2& p) {
  constexpr double kStep = 1e-5;
  const Vec2 x(kStep, 0), y(0, kStep);
  return Vec2(field(p + x) - field(p - x), field(p + y) - field(p - y)) / (2 * kStep);
}

/// Moves points of the rectangle onto the lines of the ornament that are near.
void add_lines(const Ornament& ornament, const Field& height, const Vec2& half, std::size_t count,
               Random& random, std::vector<Vec3>& lines) {
  constexpr double kNear = 0.02, kExact = 1e-4;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 start{random.uniform(-half.x(), half.x()), random.uniform(-half.y(), half.y())};
    for (const double level : ornament.lines()) {
      Vec2 p = start;
      double off = ornament.field(p) - level;
      if (std::abs(off) > kNear) continue;
      for (int step = 0; step < 4 && std::abs(off) > kExact; ++step) {
        const Vec2 slope = gradient(ornament.field, p);
        if (slope.squaredNorm() < 0.1) break;
        p -= off * slope / slope.squaredNorm();
        off = ornament.field(p) - level;
      }
      const bool inside = (p.cwiseAbs() - half).maxCoeff() < 0.0;
      if (std::abs(off) <= kExact && inside) lines.emplace_back(p.x(), p.y(), height(p));
    }
  }
}

constexpr std::uint64_t kReliefs = 16;
constexpr std::size_t kReliefSamplesPerPoint = 10;

}  // namespace

Relief random_relief(Random& random, std::size_t line_points) {
  const Vec2 half{random.uniform(0.4, 1.0), random.uniform(0.3, 0.5)};
  const auto ornaments = random_ornaments(random, half);
  const Field base = relief_plate(random);
  const Field height = [ornaments, base](const Vec2& p) {
    double z = base(p);
    for (const Ornament& ornament : ornaments) z += ornament.at(p);
    return z;
  };
  HeightField field;
  field.height = [height](double x, double y) { return height({x, y}); };
  field.gradient = [height](double x, double y) { return gradient(height, {x, y}); };
  field.max_slope = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Vec2 p{random.uniform(-half.x(), half.x()), random.uniform(-half.y(), half.y())};
    field.max_slope = std::max(field.max_slope, 1.0 + 1.5 * gradient(height, p).norm());
  }
  const auto gradient_of = field.gradient;
  // A flank that the probes missed must not be steeper than the bound says.
  field.gradient = [gradient_of, bound = field.max_slope](double x, double y) {
    const Vec2 slope = gradient_of(x, y);
    return slope.norm() > bound ? Vec2(slope * (bound / slope.norm())) : slope;
  };
  Relief relief;
  relief.shape.patches.push_back(graph(field, -half, half));
  add_rims(relief.shape);
  for (const Ornament& ornament : ornaments) {
    add_lines(ornament, height, half, line_points, random, relief.lines);
  }
  return relief;
}

std::vector<ReliefRecipe> relief_recipes(std::uint64_t seed) {
  std::vector<ReliefRecipe> recipes;
  for (std::uint64_t i = 0; i < kReliefs; ++i) {
    Random random(seed, 29000 + i);
    ReliefRecipe recipe;
    recipe.name = fmt::format("relief_{}", i);
    recipe.relief = i;
    recipe.points = static_cast<std::size_t>(4000.0 * std::pow(5.0, random.uniform()));
    recipe.even = random.index(5) != 0;
    recipe.wear = random.uniform(0.25, 2.0);
    recipe.bands = worn_bands(0.5 + 0.2 * recipe.wear);
    recipe.scatter = random.index(2) ? 0.0 : random.uniform(0.0, 0.15);
    recipe.estimated = random.index(3) == 0;
    recipe.inward = random.index(2) == 1;
    recipes.push_back(std::move(recipe));
  }
  return recipes;
}

GeneratedCloud generate(const ReliefRecipe& recipe, std::uint64_t seed) {
  Random random(seed, 70000 + recipe.relief);
  const Relief relief = random_relief(random);
  const double spacing = std::sqrt(surface_area(relief.shape) / static_cast<double>(recipe.points));
  SampleOptions options{.points = recipe.points};
  if (recipe.even) options.min_distance = 0.7 * spacing;
  SurfaceSamples drawn = sample_surface(relief.shape, options, random);
  const SurfaceSamples surface =
      sample_surface(relief.shape, {.points = kReliefSamplesPerPoint * recipe.points}, random);
  MeshVertices vertices;
  vertices.positions = std::move(drawn.positions);
  vertices.normals = std::move(drawn.normals);
  vertices.labels.assign(vertices.positions.size(), kNonEdge);
  const std::vector<Vec3> before_wear = vertices.positions;
  wear_off(vertices, surface, relief.lines,
           {recipe.wear * spacing, spacing * recipe.bands, recipe.scatter * spacing,
            random.uniform(0.0, 0.3) * spacing},
           random);
  label_rims(before_wear, relief.shape.rims, kBoundaryBand * spacing, vertices.labels);
  PointCloud cloud =
      finish(std::move(vertices), {recipe.estimated, recipe.inward}, gaussian_rotation(random));
  cloud.comments = {fmt::format("generated by pcednet: {}, seed {}", recipe.name, seed)};
  return {recipe.name, std::move(cloud)};
}

}  // namespace pcednet::shapes
