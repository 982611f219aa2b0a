#pragma once

#include <cstdint>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// A house with a tower, windows, a door, steps and a parapet, as a survey would deliver it:
/// 140,000 points in metres of a national grid, rounded to millimetres, noisy, denser near the
/// ground, without normals. With labels, so that what is found can be compared. This is the sample
/// of the demo, and no training cloud.
GeneratedCloud building_scan(std::uint64_t seed);

}  // namespace pcednet::shapes
