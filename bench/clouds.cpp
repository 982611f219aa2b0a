#include "clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/core/error.h"
#include "pcednet/core/random_vectors.h"

namespace pcednet::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;

Vec3 direction(Random& random) {
  for (;;) {
    const Vec3 v = uniform_vector(random, -Vec3::Ones(), Vec3::Ones());
    if (v.squaredNorm() > 0.01 && v.squaredNorm() < 1) return v.normalized();
  }
}

/// A point of the unit cube at 0 or of the sphere of radius 0.5 beside it, by area.
void add_scene_point(Random& random, Cloud& cloud) {
  if (random.uniform(0, 6 + kPi) < 6) {
    const auto face = static_cast<Eigen::Index>(random.index(6));
    Vec3 n = Vec3::Zero();
    n[face / 2] = face % 2 ? 1 : -1;
    Vec3 p = 0.5 * n;
    p[(face / 2 + 1) % 3] = random.uniform(-0.5, 0.5);
    p[(face / 2 + 2) % 3] = random.uniform(-0.5, 0.5);
    return cloud.add(p, n);
  }
  const Vec3 n = direction(random);
  cloud.add(Vec3(1.5, 0, 0) + 0.5 * n, n);
}

Cloud scene(std::size_t points) {
  Random random(1);
  Cloud cloud;
  while (cloud.positions.size() < points) add_scene_point(random, cloud);
  return cloud;
}

/// Ground that is rough at every length, over the square from -40 to 40.
double height(double x, double y) {
  double z = 0.0, length = 30.0, phase = 1.0;
  for (int octave = 0; octave < 8; ++octave) {
    const double turned = x * std::cos(phase) + y * std::sin(phase);
    const double across = y * std::cos(phase) - x * std::sin(phase);
    z += 0.05 * length * std::sin(2 * kPi * turned / length + phase) *
         std::cos(2 * kPi * across / (1.3 * length));
    length *= 0.5, phase += 2.4;
  }
  return z;
}

Vec3 ground_normal(double x, double y) {
  constexpr double kStep = 0.02;
  return Vec3((height(x - kStep, y) - height(x + kStep, y)) / (2 * kStep),
              (height(x, y - kStep) - height(x, y + kStep)) / (2 * kStep), 1.0)
      .normalized();
}

/// A tripod scan of rough ground and plants: scan lines whose points lie close along the line and
/// far across it, ten times denser near the tripod; two points of five are leaves with normals in
/// any direction; noise of range and of normals.
Cloud rough(std::size_t points) {
  constexpr double kNearest = 2.0, kFarthest = 40.0, kRangeNoise = 0.005, kNormalNoise = 0.2;
  Random random(2);
  std::vector<Vec3> plants;
  for (int i = 0; i < 150; ++i) {
    const double x = random.uniform(-30, 30), y = random.uniform(-30, 30);
    plants.emplace_back(x, y, height(x, y));
  }
  const double lines = std::sqrt(static_cast<double>(points) / 4);  // four times as many along one
  Cloud cloud;
  while (cloud.positions.size() < points) {
    if (random.uniform() < 0.4) {
      const Vec3& foot = plants[random.index(plants.size())];
      const double size = 0.5 + 2.5 * std::abs(std::sin(foot.x()));
      const Vec3 in_crown = std::cbrt(random.uniform()) * direction(random);
      cloud.add(foot + size * (in_crown + Vec3(0, 0, 1.2)), direction(random));
      continue;
    }
    const double line = std::floor(random.uniform() * lines) / lines;
    const double angle = 2 * kPi * line;
    const double range =
        kNearest * std::pow(kFarthest / kNearest, random.uniform()) + kRangeNoise * random.normal();
    const double x = range * std::cos(angle), y = range * std::sin(angle);
    const Vec3 normal = (ground_normal(x, y) + kNormalNoise * normal_vector(random)).normalized();
    cloud.add({x, y, height(x, y) + kRangeNoise * random.normal()}, normal);
  }
  return cloud;
}

/// Flat ground, two points of five above it in a layer of leaves.
Cloud vegetation(std::size_t points) {
  Random random(3);
  Cloud cloud;
  while (cloud.positions.size() < points) {
    const double x = random.uniform(), y = random.uniform();
    if (random.uniform() < 0.4) {
      const Vec3 normal = direction(random);
      cloud.add({x, y, random.uniform(0, 0.1)}, normal);
    } else {
      cloud.add({x, y, 0}, Vec3::UnitZ());
    }
  }
  return cloud;
}

/// A cube filled with points whose normals have any direction.
Cloud noise(std::size_t points) {
  Random random(4);
  Cloud cloud;
  while (cloud.positions.size() < points) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    cloud.add({x, y, z}, direction(random));
  }
  return cloud;
}

/// Nine points of ten in a blob of a thousandth of the extent, with normals of any direction.
Cloud blob(std::size_t points) {
  Random random(5);
  Cloud cloud;
  while (cloud.positions.size() < points) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const bool dense = random.uniform() < 0.9;
    const Vec3 p(x, y, z);
    const Vec3 normal = direction(random);
    cloud.add(dense ? Vec3(0.5, 0.5, 0.5) + 0.001 * normal_vector(random) : p, normal);
  }
  return cloud;
}

/// Leaves a twentieth wide, every point there twice: once for each side, with opposite normals.
Cloud leaves(std::size_t points) {
  Random random(6);
  Cloud cloud;
  Vec3 centre = Vec3::Zero(), n = Vec3::UnitZ();
  for (std::size_t i = 0; cloud.positions.size() + 1 < points; ++i) {
    if (i % 500 == 0) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      centre = Vec3(x, y, z), n = direction(random);
    }
    const Vec3 offset = 0.025 * direction(random);
    const Vec3 p = centre + (offset - n * n.dot(offset));
    cloud.add(p, n), cloud.add(p, -n);
  }
  return cloud;
}

/// The scene, with randomly flipped normals.
Cloud flipped(std::size_t points) {
  Cloud cloud = scene(points);
  Random random(7);
  for (Vec3& n : cloud.normals) n = random.index(2) ? n : Vec3(-n);
  return cloud;
}

/// The scene, half of its points in twenty patches that are a thousand times denser.
Cloud clusters(std::size_t points) {
  Cloud cloud = scene(points / 2);
  Random random(8);
  const std::size_t sparse = cloud.positions.size();
  std::vector<std::size_t> centres;
  for (int i = 0; i < 20; ++i) centres.push_back(random.index(sparse));
  while (cloud.positions.size() < points) {
    const std::size_t at = centres[random.index(centres.size())];
    const Vec3 n = cloud.normals[at];
    const Vec3 offset = 0.01 * std::sqrt(random.uniform()) * direction(random);
    cloud.add(cloud.positions[at] + (offset - n * n.dot(offset)), n);
  }
  return cloud;
}

/// A plane with a tenth of its points in one place.
Cloud copies(std::size_t points) {
  Random random(9);
  Cloud cloud;
  while (cloud.positions.size() < points) {
    const double x = random.uniform(), y = random.uniform();
    cloud.add(cloud.positions.size() % 10 ? Vec3(x, y, 0) : Vec3(0.5, 0.5, 0), Vec3::UnitZ());
  }
  return cloud;
}

}  // namespace

const std::vector<CloudKind>& cloud_kinds() {
  static const std::vector<CloudKind> kinds = {
      {"scene", "a cube beside a sphere", scene},
      {"rough", "a terrestrial scan of rough ground and plants", rough},
      {"vegetation", "flat ground under a layer of leaves", vegetation},
      {"noise", "a cube filled with points of any normal", noise},
      {"blob", "nine points of ten in a thousandth of the extent", blob},
      {"leaves", "leaves with both their sides in one place", leaves},
      {"flipped", "the scene, half of its normals turned", flipped},
      {"clusters", "the scene with patches a thousand times denser", clusters},
      {"copies", "a plane, a tenth of its points in one place", copies},
  };
  return kinds;
}

Cloud make_cloud(std::string_view name, std::size_t points) {
  for (const CloudKind& kind : cloud_kinds()) {
    if (name == kind.name) return kind.make(points);
  }
  throw Error(ErrorKind::kUsage, fmt::format("no cloud is called '{}'", name));
}

}  // namespace pcednet::bench
