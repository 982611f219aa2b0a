#pragma once

#include <cstdint>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// A simulated survey of a house with a tower, windows, a door, steps and a parapet: 140,000 points
/// in metres of a national grid, rounded to millimetres, noisy, denser near the ground, labelled,
/// without normals. This is the sample of the demo, not a training cloud.
GeneratedCloud building_scan(std::uint64_t seed);

}  // namespace pcednet::shapes
