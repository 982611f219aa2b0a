#include "workbench/shapes/surfaces/survey_roofs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "pcednet/cloud/bounding_box.h"

namespace pcednet::shapes {
namespace {

// Metres.
constexpr double kFootprint[] = {0.05, 0.2};  ///< radius
constexpr double kNoise[] = {0.005, 0.025};   ///< vertical, standard deviation
constexpr double kRowNoise = 0.01, kMostWave = 0.02, kMostShift = 0.05;
constexpr double kMargin = 0.3;
constexpr double kOneSurface = 0.5;  ///< between heights in a footprint that are averaged

constexpr double kRowsApart[] = {1.0, 1.7};  ///< spacings
constexpr double kTail = 0.05;               ///< share of points with four times the noise
constexpr int kBeamRays = 13, kLeastRays = 4;

/// Gables whose ends are cut off by a slope from half their height.
Polyhedron half_hip(Random& random) {
  const double x = random.uniform(2.5, 5.0), y = x * random.uniform(0.5, 1.0);
  const double z = y * random.uniform(0.4, 1.0), part = random.uniform(0.4, 0.7);
  const double ridge = x - y * (1.0 - part) * random.uniform(0.6, 1.2), in = y * (1.0 - part);
  const double cut = part * z;
  return {{{-x, -y, 0},
           {x, -y, 0},
           {x, y, 0},
           {-x, y, 0},
           {-x, -in, cut},
           {x, -in, cut},
           {x, in, cut},
           {-x, in, cut},
           {-ridge, 0, z},
           {ridge, 0, z}},
          {{0, 1, 5, 9, 8, 4}, {2, 3, 7, 8, 9, 6}, {5, 6, 9}, {7, 4, 8}}};
}

/// Four gables of one height to one point.
Polyhedron crossing(Random& random) {
  const double width = random.uniform(1.0, 1.8), z = width * random.uniform(0.4, 1.0);
  Polyhedron roof;
  roof.corners = {
      {width, -width, 0}, {width, width, 0}, {-width, width, 0}, {-width, -width, 0}, {0, 0, z}};
  for (int arm = 0; arm < 4; ++arm) {
    const double c[] = {1, 0, -1, 0}, s[] = {0, 1, 0, -1};
    const auto turned = [&](double x, double y, double height) {
      return Vec3(c[arm] * x - s[arm] * y, s[arm] * x + c[arm] * y, height);
    };
    const double end = width * random.uniform(1.5, 3.0);
    const int first = static_cast<int>(roof.corners.size());
    for (const Vec3& corner : {turned(end, -width, 0), turned(end, 0, z), turned(end, width, 0)}) {
      roof.corners.push_back(corner);
    }
    roof.faces.push_back({arm, first, first + 1, 4});
    roof.faces.push_back({first + 2, (arm + 1) % 4, 4, first + 1});
  }
  return roof;
}

/// A gable with two dormers on one slope.
Polyhedron dormers(Random& random) {
  const double x = random.uniform(3.5, 5.0), y = x * random.uniform(0.6, 1.0);
  const double z = y * random.uniform(0.5, 1.0);
  Polyhedron roof = {{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}, {x, 0, z}, {-x, 0, z}},
                     {{0, 1, 4, 5}, {2, 3, 5, 4}}};
  const double width = y * random.uniform(0.2, 0.35);
  const double front = -y * random.uniform(0.65, 0.85), ridge = -y * random.uniform(0.1, 0.25);
  const double eaves = ridge + (front - ridge) * random.uniform(0.3, 0.6);
  const auto height = [&](double at) { return z * (1.0 + at / y); };
  const double low = height(eaves), high = height(ridge);
  for (const double side : {-1.0, 1.0}) {
    const double at = side * x * random.uniform(0.4, 0.6);
    const int i = static_cast<int>(roof.corners.size());
    for (const Vec3& corner : {Vec3(at, ridge, high), Vec3(at, front, high),
                               Vec3(at - width, eaves, low), Vec3(at - width, front, low),
                               Vec3(at + width, eaves, low), Vec3(at + width, front, low)}) {
      roof.corners.push_back(corner);
    }
    roof.faces.push_back({i, i + 2, i + 3, i + 1});
    roof.faces.push_back({i + 1, i + 5, i + 4, i});
  }
  return roof;
}

/// A slow wave in the heights of a slope.
struct Wave {
  double height, length, phase;
  double at(const Vec3& place) const {
    return height *
           std::sin(2.0 * std::numbers::pi * (place.x() + 0.6 * place.y()) / length + phase);
  }
};

struct Chimney {
  Vec3 middle;
  double half, top;
};

/// The target of the beams.
struct Target {
  const Polyhedron& roof;
  Wave wave;
  std::vector<Chimney> chimneys;

  std::optional<double> height_at(const Vec3& place) const {
    for (const Chimney& chimney : chimneys) {
      const Vec3 off = (place - chimney.middle).cwiseAbs();
      if (std::max(off.x(), off.y()) < chimney.half) return chimney.top;
    }
    const auto height = highest_at(roof, place);
    return height ? std::optional(*height + wave.at(place)) : std::nullopt;
  }
};

/// The mean height in the footprint of the highest surface that fills enough of it. Beams whose
/// axis misses the roof do not count.
std::optional<double> beam(const Target& target, const Vec3& axis, double radius) {
  if (!highest_at(target.roof, axis)) return std::nullopt;
  std::vector<double> heights;
  for (int ray = 0; ray < kBeamRays; ++ray) {  // a spiral of equal areas
    const double away = radius * std::sqrt((ray + 0.5) / kBeamRays), angle = 2.4 * ray;
    const auto height = target.height_at(axis + away * Vec3(std::cos(angle), std::sin(angle), 0.0));
    if (height) heights.push_back(*height);
  }
  std::sort(heights.rbegin(), heights.rend());
  for (std::size_t first = 0, last = 0; first < heights.size(); first = last) {
    double sum = 0.0;
    while (last < heights.size() && heights[first] - heights[last] < kOneSurface) {
      sum += heights[last++];
    }
    if (last - first >= kLeastRays) return sum / static_cast<double>(last - first);
  }
  return std::nullopt;
}

/// A place in plan.
Vec3 draw_in(const BoundingBox& box, Random& random) {
  const double x = random.uniform(box.min.x(), box.max.x());
  return {x, random.uniform(box.min.y(), box.max.y()), 0.0};
}

/// Around the roof, with a margin.
BoundingBox surveyed_box(const Polyhedron& roof) {
  const BoundingBox box = bounding_box(roof.corners);
  return {box.min - Vec3::Constant(kMargin), box.max + Vec3::Constant(kMargin)};
}

std::vector<Chimney> draw_chimneys(const Polyhedron& roof, const BoundingBox& box, Random& random) {
  std::vector<Chimney> chimneys;
  const std::size_t count = random.index(3) ? 0 : 1 + random.index(2);
  while (chimneys.size() < count) {
    const Vec3 middle = draw_in(box, random);
    const auto height = highest_at(roof, middle);
    if (!height) continue;
    const double half = random.uniform(0.2, 0.35);
    chimneys.push_back({middle, half, *height + random.uniform(0.6, 1.2)});
  }
  return chimneys;
}

/// Points of walls below the outline.
void add_walls(std::vector<Vec3>& positions, const Polyhedron& roof, std::size_t count,
               Random& random) {
  std::vector<lines::Curve> rims = lines_of(roof);
  std::erase_if(rims, [](const auto& curve) { return curve.edge_class != kBoundary; });
  for (std::size_t i = 0; i < count; ++i) {
    const lines::Curve& rim = rims[random.index(rims.size())];
    Vec3 place = rim.points[0] + random.uniform() * (rim.points[1] - rim.points[0]);
    place.z() -= random.uniform(0.1, 1.5);
    positions.push_back(place);
  }
}

using Make = Polyhedron (*)(Random&);
constexpr std::array<std::pair<const char*, Make>, 3> kMore = {
    {{"half_hip", half_hip}, {"crossing", crossing}, {"dormers", dormers}}};

}  // namespace

const char* survey_roof_kind_name(int kind) {
  return kind < kRoofKinds ? roof_kind_name(kind)
                           : kMore.at(static_cast<std::size_t>(kind - kRoofKinds)).first;
}

Polyhedron random_survey_roof(int kind, Random& random) {
  Polyhedron roof = kind < kRoofKinds
                        ? random_roof(kind, random)
                        : kMore.at(static_cast<std::size_t>(kind - kRoofKinds)).second(random);
  if (random.index(2)) {
    const Mat3 turn = Eigen::AngleAxisd(random.uniform(0.0, 2.0 * std::numbers::pi), Vec3::UnitZ())
                          .toRotationMatrix();
    for (Vec3& corner : roof.corners) corner = turn * corner;
  }
  return roof;
}

std::vector<Vec3> survey_points(const Polyhedron& roof, std::size_t points, Random& random) {
  constexpr int kTrials = 2000;
  const BoundingBox box = surveyed_box(roof);
  int on_roof = 0;
  for (int i = 0; i < kTrials; ++i) on_roof += highest_at(roof, draw_in(box, random)).has_value();
  const Vec3 size = box.max - box.min;
  const double area = size.x() * size.y() * on_roof / kTrials;
  const double apart =
      random.uniform(kRowsApart[0], kRowsApart[1]) * std::sqrt(area / static_cast<double>(points));
  const double radius = random.uniform(kFootprint[0], kFootprint[1]);
  const double noise = random.uniform(kNoise[0], kNoise[1]);
  const double shift = random.uniform(-kMostShift, kMostShift);
  const double first = random.index(2) ? box.min.x() + kMargin : random.uniform(0.0, apart);
  Target target = {roof, {}, draw_chimneys(roof, box, random)};
  target.wave = {random.uniform(0.0, kMostWave), random.uniform(3.0, 8.0),
                 random.uniform(0.0, 2.0 * std::numbers::pi)};
  std::vector<Vec3> positions;
  if (random.index(3) == 0) add_walls(positions, roof, points / 100, random);
  while (positions.size() < points) {
    Vec3 place = draw_in(box, random);
    place.x() = first + apart * std::round((place.x() - first) / apart) +
                kRowNoise * std::abs(random.normal());
    const auto height = beam(target, place, radius);
    if (!height) continue;
    const double tail = random.uniform() < kTail ? 4.0 : 1.0;
    place.z() = *height + shift + tail * noise * random.normal();
    positions.push_back(place);
  }
  return positions;
}

}  // namespace pcednet::shapes
