#include "workbench/render/splat.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"

namespace pcednet::render {
namespace {

using Eigen::Vector3f;

constexpr int kBandRows = 32;
constexpr std::size_t kSurfelsAtOnce = 4096;
constexpr float kDot = 0.4f;  // of the squared radius of an edge disc: there it covers all else
constexpr float kEdgeRadius = 0.65f;   // at edges discs stand out from the surface: smaller there
constexpr float kLeastFacing = 0.12f;  // discs are never seen flatter than this
constexpr float kBlend = 1.3f;         // radius of the blended disc, where 1 is the one that hides
constexpr float kLargestRadius = 0.04f;  // of the longer side of the picture

/// A surfel on the screen.
struct Splat {
  float x, y, depth;
  float radius;            ///< pixels
  float slope_x, slope_y;  ///< depth per pixel
  float pixel;             ///< length of a pixel's side at this depth
  Vector3f normal;         ///< in camera space, towards the eye
  Rgb colour;
  bool edge;
  bool seen;
};

Splat project(const Surfel& surfel, const Camera& camera, float min_radius) {
  Splat splat{};
  const Vector3f p = camera.to_camera(surfel.position);
  if (!(p.z() > 1e-3f)) return splat;
  const float longer = static_cast<float>(std::max(camera.width, camera.height));
  splat.pixel = p.z() / camera.focal;
  splat.x = 0.5f * static_cast<float>(camera.width) + p.x() / splat.pixel;
  splat.y = 0.5f * static_cast<float>(camera.height) - p.y() / splat.pixel;
  splat.depth = p.z();
  splat.radius = std::clamp((surfel.edge ? kEdgeRadius : 1.0f) * surfel.radius / splat.pixel,
                            min_radius, kLargestRadius * longer);
  splat.normal = camera.axes * surfel.normal;
  if (splat.normal.dot(p) > 0.0f) splat.normal = -splat.normal;
  const float facing = std::max(-splat.normal.z(), kLeastFacing);
  const float tilt = surfel.edge ? 0.0f : splat.pixel / facing;
  splat.slope_x = splat.normal.x() * tilt;
  splat.slope_y = -splat.normal.y() * tilt;
  splat.colour = surfel.colour;
  splat.edge = surfel.edge;
  splat.seen = splat.x + splat.radius > 0 && splat.x - splat.radius < camera.width &&
               splat.y + splat.radius > 0 && splat.y - splat.radius < camera.height;
  return splat;
}

/// Calls `paint(column, depth, sq_distance)` for each pixel of `row` whose centre the disc covers;
/// `sq_distance` is 0 at the centre of the disc, 1 at its rim. The disc has `radius` pixels.
template <typename Paint>
void for_each_pixel(const Splat& splat, float radius, int row, int width, Paint&& paint) {
  const float dy = static_cast<float>(row) + 0.5f - splat.y;
  const float reach_sq = radius * radius - dy * dy;
  if (reach_sq <= 0.0f) return;
  const float reach = std::sqrt(reach_sq);
  const int begin = std::max(0, static_cast<int>(std::ceil(splat.x - reach - 0.5f)));
  const int end = std::min(width, static_cast<int>(std::floor(splat.x + reach - 0.5f)) + 1);
  const float inverse = 1.0f / (radius * radius * splat.pixel * splat.pixel);
  for (int column = begin; column < end; ++column) {
    const float dx = static_cast<float>(column) + 0.5f - splat.x;
    const float rise = splat.slope_x * dx + splat.slope_y * dy;
    const float sq = ((dx * dx + dy * dy) * splat.pixel * splat.pixel + rise * rise) * inverse;
    if (sq < 1.0f) paint(column, splat.depth + rise, sq);
  }
}

/// The light that a white surface sends to the eye.
float brightness(const Vector3f& normal) {
  const Vector3f key = Vector3f(-0.45f, 0.70f, -0.75f).normalized();
  const Vector3f fill = Vector3f(0.70f, 0.15f, -0.60f).normalized();
  return 0.58f + 0.28f * std::max(0.0f, normal.dot(key)) + 0.10f * std::max(0.0f, normal.dot(fill));
}

/// The sum of the discs on a pixel.
struct Sum {
  float weight = 0.0f;
  float plain_weight = 0.0f;  ///< of discs that are not edges
  float depth = 0.0f;
  Vector3f normal = Vector3f::Zero();
  Vector3f colour = Vector3f::Zero();
  float sq_distance = kNoDepth;       ///< to the nearest point that is not an edge
  float edge_sq_distance = kNoDepth;  ///< to the nearest edge point
  Rgb edge_colour{};
};

void add(Sum& sum, const Splat& splat, float depth, float sq_distance) {
  const float weight = (1.0f - sq_distance) * (1.0f - sq_distance) + 1e-4f;
  sum.weight += weight;
  sum.depth += weight * depth;
  sum.normal += weight * splat.normal;
  float length = sq_distance * splat.radius * splat.radius;
  if (splat.edge) length *= sq_distance < kDot ? 0.1f : 0.7f;
  if (!splat.edge) {
    sum.sq_distance = std::min(sum.sq_distance, length);
    sum.plain_weight += weight;
    sum.colour += weight * Vector3f(splat.colour[0], splat.colour[1], splat.colour[2]);
  } else if (length < sum.edge_sq_distance ||
             (length == sum.edge_sq_distance && splat.colour < sum.edge_colour)) {
    sum.edge_sq_distance = length;
    sum.edge_colour = splat.colour;
  }
}

Rgb lit_colour(const Sum& sum, bool edge, const Vector3f& surface_colour) {
  const float light = brightness(sum.normal.normalized());
  Rgb lit;
  for (int c = 0; c < 3; ++c) {
    const float value = edge ? static_cast<float>(sum.edge_colour[c]) * (0.55f + 0.5f * light)
                             : surface_colour[c] * light;
    lit[c] = static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
  }
  return lit;
}

class Band {
 public:
  Band(Layer& layer, int first_row)
      : layer_(layer),
        first_(first_row),
        end_(std::min(first_row + kBandRows, layer.height)),
        front_(static_cast<std::size_t>(end_ - first_) * layer.width, kNoDepth),
        sums_(front_.size()) {}

  /// Keeps the depth of the nearest disc.
  void cover(const Splat& splat) {
    for_each_row(splat, splat.radius, [&](int row, std::size_t offset) {
      for_each_pixel(splat, splat.radius, row, layer_.width, [&](int column, float depth, float) {
        float& front = front_[offset + static_cast<std::size_t>(column)];
        front = std::min(front, depth);
      });
    });
  }

  /// Adds the disc where it is not behind another.
  void blend(const Splat& splat) {
    const float thickness = (splat.edge ? 2.5f : 1.1f) * splat.radius * splat.pixel;
    const float radius = kBlend * splat.radius;
    for_each_row(splat, radius, [&](int row, std::size_t offset) {
      for_each_pixel(splat, radius, row, layer_.width,
                     [&](int column, float depth, float sq_distance) {
                       const std::size_t pixel = offset + static_cast<std::size_t>(column);
                       if (depth <= front_[pixel] + thickness)
                         add(sums_[pixel], splat, depth, sq_distance);
                     });
    });
  }

  void resolve() {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const Sum& sum = sums_[i];
      if (front_[i] == kNoDepth) continue;
      const std::size_t pixel = static_cast<std::size_t>(first_) * layer_.width + i;
      const bool edge = sum.edge_sq_distance < sum.sq_distance;
      layer_.depth[pixel] = sum.depth / sum.weight;
      layer_.colour[pixel] = lit_colour(sum, edge, sum.colour / sum.plain_weight);
    }
  }

 private:
  template <typename Work>
  void for_each_row(const Splat& splat, float radius, Work&& work) {
    const int begin = std::max(first_, static_cast<int>(std::floor(splat.y - radius)));
    const int end = std::min(end_, static_cast<int>(std::floor(splat.y + radius)) + 1);
    for (int row = begin; row < end; ++row) {
      work(row, static_cast<std::size_t>(row - first_) * static_cast<std::size_t>(layer_.width));
    }
  }

  Layer& layer_;
  int first_, end_;
  std::vector<float> front_;
  std::vector<Sum> sums_;
};

/// For each band the splats that touch it, in their order.
std::vector<std::vector<std::uint32_t>> sort_into_bands(const std::vector<Splat>& splats,
                                                        int height) {
  const int count = (height + kBandRows - 1) / kBandRows;
  std::vector<std::vector<std::uint32_t>> bands(static_cast<std::size_t>(count));
  const auto band_at = [&](float y) {
    const float row = std::clamp(y, 0.0f, static_cast<float>(height - 1));
    return static_cast<std::size_t>(row) / kBandRows;
  };
  for (std::size_t i = 0; i < splats.size(); ++i) {
    if (!splats[i].seen) continue;
    const float radius = kBlend * splats[i].radius;
    const std::size_t last = band_at(splats[i].y + radius);
    for (std::size_t b = band_at(splats[i].y - radius); b <= last; ++b) {
      bands[b].push_back(static_cast<std::uint32_t>(i));
    }
  }
  return bands;
}

void measure_grain(Layer& layer, const std::vector<Splat>& splats) {
  std::vector<float> lengths, pixels;
  for (const Splat& splat : splats) {
    if (!splat.seen) continue;
    lengths.push_back(splat.radius * splat.pixel);
    pixels.push_back(splat.radius);
  }
  if (pixels.empty()) return;
  layer.grain = upper_median(std::move(lengths));
  layer.grain_pixels = upper_median(std::move(pixels));
}

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

Layer draw(std::span<const Surfel> surfels, const Camera& camera, float min_radius) {
  std::vector<Splat> splats(surfels.size());
  parallel_blocks(surfels.size(), kSurfelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) splats[i] = project(surfels[i], camera, min_radius);
  });
  const auto bands = sort_into_bands(splats, camera.height);

  Layer layer{camera.width, camera.height, {}, {}};
  measure_grain(layer, splats);
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  layer.depth.assign(pixels, kNoDepth);
  layer.colour.assign(pixels, Rgb{});
  parallel_blocks(bands.size(), 1, [&](std::size_t b, std::size_t) {
    Band band(layer, static_cast<int>(b) * kBandRows);
    for (const std::uint32_t i : bands[b]) band.cover(splats[i]);
    for (const std::uint32_t i : bands[b]) band.blend(splats[i]);
    band.resolve();
  });
  return layer;
}

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
