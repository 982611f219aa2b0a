#include "workbench/render/gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/core/parallel.h"

namespace pcednet::render {
namespace {

constexpr std::size_t kRowsAtOnce = 16;
constexpr float kDeep = 2.0f;   // grains between a surface and the background seen through a hole
constexpr float kAlike = 2.0f;  // grains between the estimates of the four lines

struct PixelOffset {
  int x, y;
};

/// Four lines through a pixel, by one of their ends.
std::array<PixelOffset, 4> lines(int reach) {
  const int diagonal = static_cast<int>(std::lround(0.707 * reach));
  return {{{reach, 0}, {diagonal, diagonal}, {0, reach}, {-diagonal, diagonal}}};
}

int luminance(const Rgb& c) {
  return c[0] + c[1] + c[2];
}

/// Fills the pixel if it is closed in along all four lines, with the lightest colour around, which
/// adds no edge; says whether.
bool fill(const Layer& open, const std::array<PixelOffset, 4>& ends, std::size_t pixel,
          Layer& closed) {
  float least = kNoDepth, most = -kNoDepth, sum = 0.0f;
  Rgb colour{};
  for (const PixelOffset& end : ends) {
    const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(end.y) * open.width + end.x;
    const std::size_t a = pixel + static_cast<std::size_t>(step);
    const std::size_t b = pixel - static_cast<std::size_t>(step);
    // For a plane at any slant, this is its value in the middle.
    const float middle = 0.5f * (open.depth[a] + open.depth[b]);
    if (!(open.depth[pixel] > middle + kDeep * open.grain)) return false;
    least = std::min(least, middle), most = std::max(most, middle), sum += middle;
    for (const std::size_t rim : {a, b}) {
      if (luminance(open.colour[rim]) > luminance(colour)) colour = open.colour[rim];
    }
  }
  if (most - least > kAlike * open.grain) return false;
  closed.depth[pixel] = sum / 4.0f;
  closed.colour[pixel] = colour;
  return true;
}

}  // namespace

void close_gaps(Layer& layer, int size) {
  const int reach = size + 1;
  if (layer.width <= 2 * reach || layer.height <= 2 * reach) return;
  // The short lines find small holes close to a rim, the long ones larger holes.
  const std::array<PixelOffset, 4> ends = lines(reach), close_ends = lines(reach / 2 + 1);
  const Layer open = layer;
  const std::size_t inner_rows = static_cast<std::size_t>(layer.height - 2 * reach);
  parallel_blocks(inner_rows, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin + reach; row < end + reach; ++row) {
      for (int x = reach; x < layer.width - reach; ++x) {
        const std::size_t pixel = row * layer.width + x;
        if (!fill(open, close_ends, pixel, layer)) fill(open, ends, pixel, layer);
      }
    }
  });
}

}  // namespace pcednet::render
