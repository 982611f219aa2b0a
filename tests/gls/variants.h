#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <optional>

#include "gls/test_clouds.h"

namespace pcednet::gls::test {

/// A way to reconstruct that a test runs with.
struct Variant {
  const char* name;
  Reconstruction reconstruction;
  std::optional<double> gate;
};

inline ScaleSpaceOptions options_of(const Variant& variant, FeatureSet features) {
  ScaleSpaceOptions options;
  options.features = features;
  options.reconstruction = variant.reconstruction;
  options.side_gate = variant.gate;
  return options;
}

/// A noisy cube in which every hundredth point has a twin with another normal, a twin with the same
/// normal, an unusable normal, or no position.
inline Cloud awkward_cloud(std::size_t count) {
  Cloud cloud = cube(count, 21, 0.005, 0.2);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Stream stream(22);
  for (std::size_t i = 0; i + 60 < count; i += 100) {
    cloud.add(cloud.positions[i], stream.direction());
    cloud.add(cloud.positions[i + 20], cloud.normals[i + 20]);
    cloud.normals[i + 40] = i % 200 ? Vec3(0, 0, 0) : Vec3(0, kNan, 1);
    cloud.positions[i + 60].y() = i % 200 ? kNan : std::numeric_limits<double>::infinity();
  }
  return cloud;
}

template <typename Number>
void expect_same_bits(const Matrix<Number>& a, const Matrix<Number>& b) {
  ASSERT_EQ(a.features.size(), b.features.size());
  EXPECT_EQ(std::memcmp(a.features.data(), b.features.data(), a.features.size() * sizeof(Number)),
            0);
  EXPECT_EQ(a.status, b.status);
}

}  // namespace pcednet::gls::test
