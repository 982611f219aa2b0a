#pragma once

#include <array>
#include <string_view>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet {

/// The edge classes by number: their names, and their colours, the paper's except for boundary.
struct EdgeClassEntry {
  EdgeClass edge_class;
  std::string_view name;
  Rgb colour;
};
inline constexpr std::array<EdgeClassEntry, 4> kEdgeClasses = {{
    {kNonEdge, "non-edge", {255, 255, 255}},
    {kSmoothEdge, "smooth-edge", {255, 196, 93}},
    {kSharpEdge, "sharp-edge", {168, 0, 0}},
    {kBoundary, "boundary", {0, 82, 165}},
}};
static_assert(kEdgeClasses[kSmoothEdge].edge_class == kSmoothEdge &&
              kEdgeClasses[kSharpEdge].edge_class == kSharpEdge &&
              kEdgeClasses[kBoundary].edge_class == kBoundary);

}  // namespace pcednet
