#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

struct DefaultSetOptions {
  /// Adds the shapes beyond the paper's six (their names start with "x_").
  bool extras = true;
  /// If given, the bands of every cloud, in spacings, instead of its own.
  std::optional<EdgeBands> bands = {};
};

/// The Default training set of Himeur et al. 2021, remade from their description: six shapes, point
/// counts, class shares and noisy variants (287,900 points in nine clouds). Further clouds add
/// properties of real scans: other angles, edges that fade out or are rounded, open borders, uneven
/// density, stronger noise. See docs/shapes.md.
///
/// `seed` determines the random shapes.
std::vector<Recipe> default_recipes(std::uint64_t seed, const DefaultSetOptions& options = {});

}  // namespace pcednet::shapes
