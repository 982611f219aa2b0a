#pragma once

#include <cmath>

#include "gls/test_clouds.h"
#include "pcednet/gls/engine/fast_scale_space.h"

namespace pcednet::gls::test {

/// A helix with the normals of its tube: neighbourhoods that hold a curve.
inline Cloud curve(std::size_t count) {
  Stream stream(31);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = 20 * stream.uniform();
    const Vec3 radial(std::cos(a), std::sin(a), 0);
    cloud.add(radial + Vec3(0, 0, 0.1 * a), radial);
  }
  return cloud;
}

/// A ball filled with points whose normals point away from its centre.
inline Cloud volume(std::size_t count) {
  Stream stream(32);
  Cloud cloud;
  while (cloud.positions.size() < count) {
    const Vec3 n = stream.direction();
    cloud.add(std::cbrt(stream.uniform()) * n, n);
  }
  return cloud;
}

/// The scene with every tenth point in a patch a thousandth of its area: the patch is about a
/// hundred times as dense.
inline Cloud uneven(std::size_t count) {
  Cloud cloud = scene(count, 33);
  Stream stream(34);
  for (std::size_t i = 0; i < count; i += 10) {
    cloud.positions[i] = Vec3(0.1 * stream.uniform(), 0.1 * stream.uniform(), 0.5);
    cloud.normals[i] = Vec3::UnitZ();
  }
  return cloud;
}

/// A noisy cube with every point there twice, and half of all points in one place.
inline Cloud copies(std::size_t count) {
  Cloud cloud = cube(count / 4, 35, 0.003, 0.1);
  for (std::size_t i = 0; i < count / 4; ++i) cloud.add(cloud.positions[i], cloud.normals[i]);
  while (cloud.positions.size() < count) cloud.add(Vec3(0.5, 0.1, 0.2), Vec3::UnitX());
  return cloud;
}

/// The scene, with points far away from everything at three distances.
inline Cloud outliers(std::size_t count) {
  Cloud cloud = scene(count, 36);
  for (const double far : {5.0, 1e3, 1e6}) {
    cloud.add(Vec3(far, 0, 0), Vec3::UnitX());
    cloud.add(Vec3(0, -far, far), Vec3::UnitY());
  }
  return cloud;
}

inline Matrix<float> describe(const FastScaleSpace& space,
                              const std::vector<std::uint32_t>& targets) {
  const std::size_t scales = space.scales().size();
  const auto width = static_cast<std::size_t>(feature_count(space.options().features));
  Matrix<float> matrix{scales, width, {}, {}};
  matrix.features.assign(targets.size() * scales * width, -77.0f);
  matrix.status.assign(targets.size() * scales, static_cast<FitStatus>(77));
  space.describe(targets, matrix.features, matrix.status);
  return matrix;
}

}  // namespace pcednet::gls::test
