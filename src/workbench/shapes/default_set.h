#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

struct DefaultSetOptions {
  /// Whether to add the shapes beyond the paper's six (their names start with "x_").
  bool extras = true;
  /// If given, the bands of every cloud, in spacings, in place of its own.
  std::optional<EdgeBands> bands = {};
};

/// How each cloud of generate_default() is made. `seed` decides the shapes that are random.
std::vector<Recipe> default_recipes(std::uint64_t seed, const DefaultSetOptions& options = {});

/// The Default training set of Himeur et al. 2021, made anew from their description: their six
/// shapes, point counts, class shares and noisy variants (287,900 points in nine clouds), and,
/// beyond the paper, clouds for what real scans hold: other angles, edges that fade out or are
/// rounded, open borders, uneven density, stronger noise. See docs/shapes.md.
///
/// The same seed gives the same clouds.
std::vector<GeneratedCloud> generate_default(std::uint64_t seed,
                                             const DefaultSetOptions& options = {});

}  // namespace pcednet::shapes
