#include "workbench/render/png.h"

#include <fmt/format.h>
#include <png.h>

#include "pcednet/core/error.h"

namespace pcednet::render {

std::vector<std::byte> encode_png(const Image& image) {
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
    throw Error(ErrorKind::kFailure, fmt::format("cannot encode a picture: {}", header.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace pcednet::render
