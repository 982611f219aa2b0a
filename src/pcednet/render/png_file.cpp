#include "pcednet/render/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include <cstddef>
#include <vector>

#include "pcednet/core/error.h"

namespace pcednet::render {

void write_png(const std::filesystem::path& path, const Image& image, Overwrite overwrite) {
  OutputFile file(path, overwrite);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  header.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::vector<std::byte> bytes(size);
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0,
                                 nullptr)) {
    throw Error(ErrorKind::kFailure,
                fmt::format("{}: cannot encode the picture: {}", path.string(), header.message));
  }
  file.write(std::span(bytes).first(size));
  file.commit();
}

}  // namespace pcednet::render
