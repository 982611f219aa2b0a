#pragma once

#include <filesystem>

#include "pcednet/core/output_file.h"
#include "pcednet/render/shade.h"

namespace pcednet::render {

/// Writes `image` as a PNG; the same image gives the same bytes. Errors as of OutputFile.
void write_png(const std::filesystem::path& path, const Image& image, Overwrite overwrite);

}  // namespace pcednet::render
