#pragma once

#include <cstddef>
#include <vector>

#include "workbench/render/shade.h"

namespace pcednet::render {

/// The bytes of a PNG file; the same for the same image. Throws Error(kFailure) if libpng refuses.
std::vector<std::byte> encode_png(const Image& image);

}  // namespace pcednet::render
