#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/point_cloud.h"

namespace pcednet::annotate {

/// kFile takes the points that have the class in the input.
enum class Tool { kBrush, kPolygon, kFile };

/// One use of a tool. Coordinates are local: minus the session's origin.
struct Stroke {
  std::string id = {};  ///< the window's own name for it
  Tool tool = Tool::kBrush;
  std::size_t cloud = 0;
  std::uint8_t edge_class = kUnlabelled;  ///< of the project's classes; kUnlabelled erases
  bool protect = false;                   ///< points that have a label keep it
  std::vector<std::uint8_t> hidden = {};  ///< points of these classes are not painted
  std::optional<BoundingBox> clip = {};   ///< only points within it are painted

  std::vector<Vec3> centres = {};  ///< of the brush
  double radius = 0;

  std::vector<std::array<double, 2>> polygon = {};  ///< in clip space, -1 to 1
  std::array<double, 16> matrix = {};               ///< local to clip space, column-major
  bool front_only = false;
  double point_size = 1;                    ///< pixels
  std::array<double, 2> viewport = {1, 1};  ///< pixels
};

}  // namespace pcednet::annotate
