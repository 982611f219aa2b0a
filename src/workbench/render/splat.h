#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "workbench/render/camera.h"
#include "workbench/render/surfels.h"

namespace pcednet::render {

constexpr float kNoDepth = std::numeric_limits<float>::infinity();

/// What each pixel shows, row by row from the top.
struct Layer {
  int width = 0, height = 0;
  std::vector<float> depth;   ///< along the line of sight; kNoDepth where nothing is seen
  std::vector<Rgb> colour;    ///< lit
  float grain = 0.0f;         ///< median radius of the discs: details below it are not real
  float grain_pixels = 0.0f;  ///< the same on the screen
};

/// Draws the surfels (at least one): hidden ones hidden, visible ones that overlap blended into one
/// surface, edges on top of it. No disc is smaller than `min_radius` pixels.
Layer draw(std::span<const Surfel> surfels, const Camera& camera, float min_radius);

}  // namespace pcednet::render
