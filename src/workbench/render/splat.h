#pragma once

#include <limits>
#include <span>
#include <vector>

#include "workbench/render/camera.h"
#include "workbench/render/surfels.h"

namespace pcednet::render {

constexpr float kNoDepth = std::numeric_limits<float>::infinity();

/// Depth and colour per pixel, row by row from the top.
struct Layer {
  int width = 0, height = 0;
  std::vector<float> depth;   ///< along the line of sight; kNoDepth where empty
  std::vector<Rgb> colour;    ///< lit
  float grain = 0.0f;         ///< median radius of the discs: finer details are artefacts
  float grain_pixels = 0.0f;  ///< the same on the screen
};

/// Draws the surfels (at least one) with a z-buffer, blends overlapping visible ones into one
/// surface, and draws edges on top. No disc is smaller than `min_radius` pixels.
Layer draw(std::span<const Surfel> surfels, const Camera& camera, float min_radius);

/// Closes the small holes, up to `size` pixels across, that the randomness of a sampling leaves in
/// a surface; slits and openings stay open.
void close_gaps(Layer& layer, int size);

}  // namespace pcednet::render
