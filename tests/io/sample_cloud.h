#pragma once

#include <limits>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/random.h"

namespace pcednet::io {

/// A cloud with something of everything; positions are floats, a NaN among them.
inline PointCloud sample_cloud(std::size_t points = 50) {
  Random random(11);
  PointCloud cloud;
  cloud.position_type = ScalarType::kFloat32;
  std::vector<float> quality, p_sharp;
  std::vector<std::uint8_t> edge_class;
  std::vector<std::int16_t> intensity;
  for (std::size_t i = 0; i < points; ++i) {
    const auto number = [&] { return static_cast<double>(static_cast<float>(random.normal())); };
    cloud.positions.emplace_back(number(), number(), number());
    cloud.normals.push_back(Vec3(number(), number(), number()).normalized());
    cloud.colours.push_back({static_cast<std::uint8_t>(random.index(256)),
                             static_cast<std::uint8_t>(random.index(256)), 7});
    cloud.labels.push_back(static_cast<std::uint8_t>(i % 4 == 3 ? 255 : i % 4));
    quality.push_back(static_cast<float>(random.uniform()));
    p_sharp.push_back(static_cast<float>(random.uniform()));
    edge_class.push_back(static_cast<std::uint8_t>(random.index(3)));
    intensity.push_back(static_cast<std::int16_t>(random.next()));
  }
  if (points > 2) {
    cloud.positions[2].y() = std::numeric_limits<double>::quiet_NaN();
    cloud.positions[1].z() = -0.0;
  }
  cloud.attributes = {
      make_attribute("intensity", intensity), make_attribute("scalar_p_sharp", p_sharp),
      make_attribute("scalar_edge_class", edge_class), make_attribute("quality", quality)};
  cloud.comments = {"made by a test", "obj_info of its own"};
  return cloud;
}

/// What is left of normals in a file.
inline std::vector<Vec3> as_floats(const std::vector<Vec3>& normals) {
  std::vector<Vec3> rounded;
  for (const Vec3& n : normals) rounded.emplace_back(n.cast<float>().cast<double>().normalized());
  return rounded;
}

}  // namespace pcednet::io
