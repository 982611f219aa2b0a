#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/json.h"
#include "pcednet/core/progress.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::report {

/// Points for the page's viewer. Every string is base64 of little-endian numbers.
struct Scene {
  std::vector<std::size_t> shown;  ///< the cloud's points in the scene, in its order
  double min[3] = {0, 0, 0};       ///< the least corner of their box ...
  double size = 0;                 ///< ... and the longest side of it
  std::string positions;           ///< 3 uint16 a point: (p - min) / size * 65535, rounded
  std::string normals;         ///< 2 uint8 a point: octahedral(), 0 for -1; unit, of either sign
  float view[3] = {0, 0, -1};  ///< a good viewing direction, unit length
};

/// The finite points of `cloud`, at most `count`: those with the smallest hash of their position,
/// in the order of that hash. So the choice does not depend on the order of the points, and the
/// first n of a scene are a uniform sample of it. Normals are estimated where the cloud has none.
/// Throws Error(kInsufficient) if no point is finite.
Scene make_scene(const PointCloud& cloud, std::size_t count, const Progress* progress = nullptr);

/// The classes of the `shown` points, 4 bits a point, the first in the lower ones of a byte; 4 is
/// unlabelled. Base64.
std::string pack_classes(std::span<const std::uint8_t> classes, std::span<const std::size_t> shown);

/// RFC 4648 base64, with padding.
std::string encode_base64(std::span<const std::uint8_t> bytes);

/// The edges of the cloud with these classes, as lines::find_lines() finds them, and how the page
/// draws them: [{"class","length","path"}], the path's vertices as x, y, z, x, y, z, ... in
/// 65535ths of scene.size from scene.min.
OrderedJson find_drawn_lines(const detect::PreparedCloud& cloud,
                             std::span<const std::uint8_t> classes, const Scene& scene,
                             const Progress* progress = nullptr);

}  // namespace pcednet::report
