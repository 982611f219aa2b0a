#include "workbench/render/shade.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/core/parallel.h"

namespace pcednet::render {
namespace {

constexpr std::size_t kRows = 16;
constexpr int kBackground = 255;
constexpr int kOutline = 135;  // darker than the background

struct Ring {
  float radius;  ///< of the longer side of the picture
  float strength;
  float bound;  ///< of the contribution of one pair
};
// The first draws lines where one thing ends in front of another, the others shade hollows softly.
constexpr std::array<Ring, 3> kRings = {
    {{0.0012f, 60.0f, 0.12f}, {0.005f, 8.0f, 0.05f}, {0.016f, 2.5f, 0.05f}}};
struct Offset {
  int x, y;
};

/// Four opposite pairs of pixels, by one of the two.
using Pairs = std::array<Offset, 4>;
using Taps = std::array<Pairs, kRings.size()>;

Pairs pairs_at(float radius) {
  const int straight = std::max(1, static_cast<int>(std::lround(radius)));
  const int diagonal = std::max(1, static_cast<int>(std::lround(0.707f * radius)));
  return {{{straight, 0}, {diagonal, diagonal}, {0, straight}, {-diagonal, diagonal}}};
}

float depth_at(const Layer& layer, int x, int y) {
  if (x < 0 || y < 0 || x >= layer.width || y >= layer.height) return kNoDepth;
  return layer.depth[static_cast<std::size_t>(y) * layer.width + static_cast<std::size_t>(x)];
}

/// How much light reaches the pixel, 1 at most. A plane is linear in 1 / depth on the screen, so
/// the mean of two opposite pixels minus the middle is 0 on a plane at any slant and positive where
/// the middle lies deeper.
float openness(const Layer& layer, const Taps& taps, int x, int y, float depth) {
  float hidden = 0.0f;
  for (std::size_t r = 0; r < kRings.size(); ++r) {
    const Ring& ring = kRings[r];
    for (const auto& [dx, dy] : taps[r]) {
      const float a = depth_at(layer, x + dx, y + dy), b = depth_at(layer, x - dx, y - dy);
      if (a == kNoDepth || b == kNoDepth) continue;
      const float sag = depth * (0.5f * depth * (1.0f / a + 1.0f / b) - 1.0f);
      hidden += std::clamp(ring.strength * (sag - 0.15f * layer.grain), 0.0f, ring.bound);
    }
  }
  return std::exp(-hidden);
}

Rgb shaded(const Layer& layer, const Taps& taps, const Pairs& outline, int x, int y) {
  const std::size_t pixel = static_cast<std::size_t>(y) * layer.width + static_cast<std::size_t>(x);
  const float depth = layer.depth[pixel];
  if (depth == kNoDepth) {
    int beside = 0;
    for (const auto& [dx, dy] : outline) {
      beside += (depth_at(layer, x + dx, y + dy) != kNoDepth) +
                (depth_at(layer, x - dx, y - dy) != kNoDepth);
    }
    const auto grey = static_cast<std::uint8_t>(kBackground - kOutline * std::min(beside, 3) / 3);
    return {grey, grey, grey};
  }
  const float light = openness(layer, taps, x, y, depth);
  Rgb colour = layer.colour[pixel];
  for (std::uint8_t& c : colour)
    c = static_cast<std::uint8_t>(std::lround(static_cast<float>(c) * light));
  return colour;
}

}  // namespace

Image shade(const Layer& layer, int factor) {
  const float longer = static_cast<float>(std::max(layer.width, layer.height));
  const Pairs outline = pairs_at(static_cast<float>(factor));
  Taps taps;
  for (std::size_t r = 0; r < taps.size(); ++r) taps[r] = pairs_at(kRings[r].radius * longer);

  Image image{layer.width / factor, layer.height / factor, {}};
  image.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
  parallel_blocks(
      static_cast<std::size_t>(image.height), kRows, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          for (int column = 0; column < image.width; ++column) {
            std::array<int, 3> sum{};
            for (int k = 0; k < factor * factor; ++k) {
              const Rgb part = shaded(layer, taps, outline, column * factor + k % factor,
                                      static_cast<int>(row) * factor + k / factor);
              for (std::size_t c = 0; c < 3; ++c) sum[c] += part[c];
            }
            const int count = factor * factor;
            for (std::size_t c = 0; c < 3; ++c) {
              image.pixels[row * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(column)][c] =
                  static_cast<std::uint8_t>((sum[c] + count / 2) / count);
            }
          }
        }
      });
  return image;
}

}  // namespace pcednet::render
