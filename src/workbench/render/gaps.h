#pragma once

#include "workbench/render/splat.h"

namespace pcednet::render {

/// Closes the small holes, up to `size` pixels across, that the randomness of a sampling leaves in
/// a surface; slits and openings stay open.
void close_gaps(Layer& layer, int size);

}  // namespace pcednet::render
