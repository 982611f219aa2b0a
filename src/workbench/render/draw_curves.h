#pragma once

#include <span>

#include "pcednet/lines/curve.h"
#include "workbench/render/camera.h"
#include "workbench/render/shade.h"
#include "workbench/render/splat.h"

namespace pcednet::render {

/// Draws curves over the picture that `layer` was shaded to, in the colours of their classes; the
/// points in which curves end together become dots. What lies behind the surface fades away.
/// `image` is `layer` shrunk by a whole number; `box` is where the surfels come from.
void draw_curves(Image& image, const Layer& layer, const Camera& camera, const UnitBox& box,
                 std::span<const lines::Curve> curves);

}  // namespace pcednet::render
