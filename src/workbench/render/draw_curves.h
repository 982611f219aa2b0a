#pragma once

#include <span>

#include "pcednet/lines/curve.h"
#include "workbench/render/camera.h"
#include "workbench/render/shade.h"
#include "workbench/render/splat.h"

namespace pcednet::render {

/// Draws curves over the picture shaded from `layer`, in the colours of their classes; points where
/// curves end together become dots. Hidden parts fade. `image` is `layer` reduced by an integer
/// factor; `box` is the place of the surfels in the cloud.
void draw_curves(Image& image, const Layer& layer, const Camera& camera, const UnitBox& box,
                 std::span<const lines::Curve> curves);

}  // namespace pcednet::render
