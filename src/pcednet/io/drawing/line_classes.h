#pragma once

#include <array>
#include <string_view>

#include "pcednet/cloud/class_table.h"
#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// A class of curves: the layer, group or attribute that it has in files, and its colour.
struct LineClass {
  EdgeClass edge_class;
  std::string_view name;
  Rgb colour;
  int dxf_colour;  ///< the nearest of AutoCAD's 255
};

/// In the order of layers and groups.
inline constexpr std::array<LineClass, 3> kLineClasses = {{
    {kSharpEdge, kEdgeClasses[kSharpEdge].name, kEdgeClasses[kSharpEdge].colour, 12},
    {kSmoothEdge, kEdgeClasses[kSmoothEdge].name, kEdgeClasses[kSmoothEdge].colour, 31},
    {kBoundary, kEdgeClasses[kBoundary].name, kEdgeClasses[kBoundary].colour, 152},
}};

/// The entry of a class; that of sharp edges for a class without lines.
inline const LineClass& line_class(EdgeClass edge_class) {
  for (const LineClass& entry : kLineClasses) {
    if (entry.edge_class == edge_class) return entry;
  }
  return kLineClasses[0];
}

}  // namespace pcednet::io
