#pragma once

#include <vector>

#include "pcednet/core/random.h"
#include "workbench/shapes/shape.h"

namespace pcednet::shapes {

/// A carved or cast surface with open borders: a bent plate with raised or sunken ornaments.
struct Relief {
  Shape shape;              ///< one patch, no edge curves
  std::vector<Vec3> lines;  ///< dense points on the ridge and valley lines of the ornaments
};

/// Discs and domes, meanders, spirals, strokes, nested rings, flutes and terraces, with steep or
/// soft flanks, on a plate about one unit large that is bent and slightly wavy. `line_points` is
/// the approximate number of points on the lines.
Relief random_relief(Random& random, std::size_t line_points = 60000);

}  // namespace pcednet::shapes
