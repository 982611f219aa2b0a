#pragma once

#include <vector>

#include "workbench/render/splat.h"

namespace pcednet::render {

/// Pixels of 8-bit red, green, blue, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;
};

/// Darkens creases and depth steps (eye-dome lighting), outlines the shape, puts it on white and
/// averages `factor` x `factor` pixels of `layer` into one.
Image shade(const Layer& layer, int factor);

}  // namespace pcednet::render
