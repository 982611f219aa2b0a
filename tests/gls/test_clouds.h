#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/exact_scale_space.h"

namespace pcednet::gls::test {

struct Cloud {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;

  OrientedPoints points() const { return {positions, normals}; }
  void add(const Vec3& position, const Vec3& normal) {
    positions.push_back(position);
    normals.push_back(normal);
  }
};

/// The stream that the golden clouds were drawn from: splitmix64 started at the bare seed, so that
/// a cloud is its formula, a size and a seed. Only + - * / and sqrt: the same bits everywhere.
class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double normal() {
    double sum = 0.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum - 6.0;
  }
  Vec3 normal3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const double x = 2 * uniform() - 1, y = 2 * uniform() - 1, z = 2 * uniform() - 1;
      const double sq = x * x + y * y + z * z;
      if (sq > 1e-4 && sq <= 1) return Vec3(x, y, z) / std::sqrt(sq);
    }
  }

 private:
  std::uint64_t state_;
};

/// A point of the unit cube centred at 0, uniform over its six faces, with the face's normal.
inline void add_cube_point(Stream& stream, Cloud& cloud) {
  const int face = static_cast<int>(stream.next() % 6);
  const double a = stream.uniform() - 0.5, b = stream.uniform() - 0.5;
  const double side = face % 2 ? 1.0 : -1.0;
  switch (face / 2) {
    case 0:
      return cloud.add({side / 2, a, b}, {side, 0, 0});
    case 1:
      return cloud.add({a, side / 2, b}, {0, side, 0});
    default:
      return cloud.add({a, b, side / 2}, {0, 0, side});
  }
}

/// Radius 2, centre (10, -5, 3).
inline Cloud sphere(std::size_t count, std::uint64_t seed) {
  Stream stream(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 n = stream.direction();
    cloud.add(Vec3(10, -5, 3) + 2 * n, n);
  }
  return cloud;
}

/// The unit cube with Gaussian noise of those deviations on positions and normals.
inline Cloud cube(std::size_t count, std::uint64_t seed, double position_noise = 0.0,
                  double normal_noise = 0.0) {
  Stream stream(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    add_cube_point(stream, cloud);
    if (position_noise == 0.0 && normal_noise == 0.0) continue;
    cloud.positions.back() += position_noise * stream.normal3();
    const Vec3 n = cloud.normals.back() + normal_noise * stream.normal3();
    cloud.normals.back() = n / std::sqrt(n.x() * n.x() + n.y() * n.y() + n.z() * n.z());
  }
  return cloud;
}

/// The axes of the cylinder below: the columns of a rotation, the third its axis.
inline Mat3 cylinder_frame() {
  Mat3 frame;
  frame << -20, 4, 22, 20, -10, 20, 10, 28, 4;
  return frame / 30;
}
inline Vec3 cylinder_centre() {
  return {100, -50, 20};
}

/// The open lateral surface of radius 0.5 and height 2.
inline Cloud cylinder(std::size_t count, std::uint64_t seed) {
  Stream stream(seed);
  const Mat3 frame = cylinder_frame();
  Cloud cloud;
  while (cloud.positions.size() < count) {
    const double x = 2 * stream.uniform() - 1, y = 2 * stream.uniform() - 1;
    const double sq = x * x + y * y;
    if (!(sq > 1e-4 && sq <= 1)) continue;
    const double cosine = x / std::sqrt(sq), sine = y / std::sqrt(sq);
    const double z = 2 * stream.uniform() - 1;
    const auto column = [&](int k) -> Vec3 { return frame.col(k); };
    cloud.add(
        cylinder_centre() + (column(0) * (cosine / 2) + column(1) * (sine / 2) + column(2) * z),
        column(0) * cosine + column(1) * sine);
  }
  return cloud;
}

/// The unit cube beside a sphere of radius 0.5, by area.
inline Cloud scene(std::size_t count, std::uint64_t seed) {
  Stream stream(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    if (stream.uniform() * (6 + 3.14159265358979323846) < 6) {
      add_cube_point(stream, cloud);
    } else {
      const Vec3 n = stream.direction();
      cloud.add(Vec3(1.5, 0, 0) + 0.5 * n, n);
    }
  }
  return cloud;
}

/// The five golden clouds by name, 10,000 points each.
inline Cloud golden_cloud(const std::string& name) {
  if (name == "sphere") return sphere(10000, 201);
  if (name == "cube") return cube(10000, 202);
  if (name == "cubeA") return cube(10000, 203, 0.003, 0.1);
  if (name == "cubeB") return cube(10000, 204, 0.015, 0.3);
  return cylinder(10000, 205);
}

inline std::vector<std::uint32_t> all_targets(std::size_t count) {
  std::vector<std::uint32_t> targets(count);
  for (std::size_t i = 0; i < count; ++i) targets[i] = static_cast<std::uint32_t>(i);
  return targets;
}

/// What describe() answers for `targets`: Number is double or float.
template <typename Number>
struct Matrix {
  std::size_t scales, width;
  std::vector<Number> features;
  std::vector<FitStatus> status;

  Number operator()(std::size_t row, std::size_t scale, std::size_t feature) const {
    return features[(row * scales + scale) * width + feature];
  }
  FitStatus status_at(std::size_t row, std::size_t scale) const {
    return status[row * scales + scale];
  }
};

template <typename Number = double>
Matrix<Number> describe(const ExactScaleSpace& space, const std::vector<std::uint32_t>& targets) {
  const std::size_t scales = space.scales().size();
  const auto width = static_cast<std::size_t>(feature_count(space.options().features));
  Matrix<Number> matrix{scales, width, {}, {}};
  matrix.features.assign(targets.size() * scales * width, Number(-77));
  matrix.status.assign(targets.size() * scales, static_cast<FitStatus>(77));
  space.describe(targets, std::span<Number>(matrix.features), matrix.status);
  return matrix;
}

template <typename Number = double>
Matrix<Number> describe(const Cloud& cloud, const ScaleSpaceOptions& options) {
  return describe<Number>(ExactScaleSpace(cloud.points(), options),
                          all_targets(cloud.positions.size()));
}

/// A cube, and from point `first` on three in turn, 20 times: of a pile of copies, of a pile of
/// cancelling normals, and of a line far from everything.
struct CubeWithPiles {
  Cloud cloud;
  std::uint32_t first;
};
inline CubeWithPiles cube_with_piles() {
  Cloud cloud = cube(3000, 2);
  const auto first = static_cast<std::uint32_t>(cloud.positions.size());
  for (int i = 0; i < 20; ++i) {
    cloud.add({3, 0, 0}, Vec3::UnitZ());
    cloud.add({0, 3, 0}, Vec3(0, 0, i % 2 ? 1 : -1));
    cloud.add({0.002 * i, 0, 3}, Vec3::UnitZ());
  }
  return {std::move(cloud), first};
}

}  // namespace pcednet::gls::test
