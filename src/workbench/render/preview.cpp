#include "workbench/render/preview.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/io/drawing/line_classes.h"
#include "workbench/render/camera.h"
#include "workbench/render/shade.h"
#include "workbench/render/splat.h"
#include "workbench/render/surfels.h"

namespace pcednet::render {
namespace {

using Eigen::Vector3f;

constexpr Rgb kCornerColour = {32, 36, 42};
constexpr float kHalfWidth = 0.0012f;  // of a line; of the longer side of the picture
constexpr float kCornerRadius = 1.9f;  // half widths
constexpr float kBias = 2.0f;          // grains of surface that may lie in front of a visible line

/// A place on the screen: pixels of the picture, and its depth.
struct Spot {
  float x, y, depth;
};

/// Lines to be drawn: their coverage of each pixel.
class Ink {
 public:
  Ink(Image& image, const Layer& layer, const Camera& camera)
      : image_(image),
        layer_(layer),
        camera_(camera),
        factor_(static_cast<float>(layer.width) / static_cast<float>(image.width)),
        half_width_(
            std::max(0.8f, kHalfWidth * static_cast<float>(std::max(image.width, image.height)))),
        drops_(image.pixels.size()) {}

  float half_width() const { return half_width_; }

  /// A pixel of the picture at a depth, in the unit of the surfels.
  float pixel_at(float depth) const { return factor_ * depth / camera_.focal; }

  /// False for points behind the eye.
  bool project(const Vector3f& position, Spot& spot) const {
    const Vector3f p = camera_.to_camera(position);
    if (!(p.z() > 1e-3f)) return false;
    const float scale = camera_.focal / (p.z() * factor_);
    spot = {0.5f * static_cast<float>(image_.width) + p.x() * scale,
            0.5f * static_cast<float>(image_.height) - p.y() * scale, p.z()};
    return true;
  }

  /// A line with round ends; a dot where `a` and `b` are one.
  void add(const Spot& a, const Spot& b, float radius, Rgb colour) {
    const auto first = [&](float at) { return static_cast<int>(std::floor(at - radius - 1.0f)); };
    const auto last = [&](float at) { return static_cast<int>(std::ceil(at + radius + 1.0f)); };
    const float width = static_cast<float>(image_.width),
                height = static_cast<float>(image_.height);
    const auto in_width = [&](float x) { return std::clamp(x, -radius, width + radius); };
    const auto in_height = [&](float y) { return std::clamp(y, -radius, height + radius); };
    const int left = std::max(0, first(in_width(std::min(a.x, b.x))));
    const int right = std::min(image_.width, last(in_width(std::max(a.x, b.x))));
    const int top = std::max(0, first(in_height(std::min(a.y, b.y))));
    const int bottom = std::min(image_.height, last(in_height(std::max(a.y, b.y))));
    const float dx = b.x - a.x, dy = b.y - a.y, sq_length = dx * dx + dy * dy;
    for (int row = top; row < bottom; ++row) {
      for (int column = left; column < right; ++column) {
        const float x = static_cast<float>(column) + 0.5f - a.x;
        const float y = static_cast<float>(row) + 0.5f - a.y;
        const float t =
            sq_length > 0.0f ? std::clamp((x * dx + y * dy) / sq_length, 0.0f, 1.0f) : 0.0f;
        const float cover = radius + 0.5f - std::hypot(x - t * dx, y - t * dy);
        if (cover <= 0.0f) continue;
        // On the screen the inverse of the depth is linear.
        const Spot on{a.x + t * dx, a.y + t * dy,
                      a.depth * b.depth / (b.depth + t * (a.depth - b.depth))};
        drop(row, column, std::min(cover, 1.0f) * seen(on), on.depth, colour);
      }
    }
  }

  /// Draws everything added onto the picture.
  void dry() {
    for (std::size_t i = 0; i < drops_.size(); ++i) {
      for (std::size_t c = 0; c < 3 && drops_[i].cover > 0.0f; ++c) {
        const float below = image_.pixels[i][c], above = drops_[i].colour[c];
        image_.pixels[i][c] =
            static_cast<std::uint8_t>(std::lround(below + drops_[i].cover * (above - below)));
      }
      drops_[i] = {};
    }
  }

 private:
  struct Drop {
    float cover = 0.0f, depth = kNoDepth;
    Rgb colour{};
  };

  void drop(int row, int column, float cover, float depth, Rgb colour) {
    Drop& there = drops_[static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) +
                         static_cast<std::size_t>(column)];
    if (cover > there.cover || (cover == there.cover && depth < there.depth)) {
      there = {cover, depth, colour};
    }
  }

  /// 1 on the surface, 0 behind it. The deepest pixel around counts: a line on a ridge or on an
  /// outline is seen although half of it is covered.
  float seen(const Spot& spot) const {
    float surface = 0.0f;
    for (const float dx : {-half_width_, 0.0f, half_width_}) {
      for (const float dy : {-half_width_, 0.0f, half_width_}) {
        const float x = factor_ * (spot.x + dx), y = factor_ * (spot.y + dy);
        if (!(x >= 0.0f && y >= 0.0f && x < static_cast<float>(layer_.width) &&
              y < static_cast<float>(layer_.height))) {
          return 1.0f;
        }
        surface = std::max(
            surface,
            layer_.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(layer_.width) +
                         static_cast<std::size_t>(x)]);
      }
    }
    const float bias = kBias * layer_.grain + half_width_ * pixel_at(spot.depth);
    return std::clamp(2.0f - (spot.depth - surface) / bias, 0.0f, 1.0f);
  }

  Image& image_;
  const Layer& layer_;
  const Camera& camera_;
  float factor_;      ///< pixels of the layer by those of the picture
  float half_width_;  ///< pixels of the picture
  std::vector<Drop> drops_;
};

/// The points in which several curves end.
std::vector<Vec3> corners(std::span<const lines::Curve> curves) {
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  };
  std::map<Vec3, int, decltype(before)> ends(before);
  for (const lines::Curve& curve : curves) {
    if (curve.closed || curve.points.empty()) continue;
    ++ends[curve.points.front()];
    ++ends[curve.points.back()];
  }
  std::vector<Vec3> shared;
  for (const auto& [place, count] : ends) {
    if (count > 1) shared.push_back(place);
  }
  return shared;
}

/// Draws curves over the picture shaded from `layer`, in the colours of their classes; points where
/// curves end together become dots. Hidden parts fade. `image` is `layer` reduced by an integer
/// factor; `box` is the place of the surfels in the cloud.
void draw_curves(Image& image, const Layer& layer, const Camera& camera, const UnitBox& box,
                 std::span<const lines::Curve> curves) {
  Ink ink(image, layer, camera);
  const double tolerance = 0.25 * box.half * static_cast<double>(ink.pixel_at(camera.eye.norm()));
  for (const lines::Curve& curve : curves) {
    const Rgb colour = io::line_class(curve.edge_class).colour;
    Spot last{}, next{};
    bool is_seen = false;  // whether `last` is in front of the eye
    for (const Vec3& vertex : lines::sampled(curve, tolerance)) {
      const bool is_next_seen = ink.project(box.to_unit(vertex), next);
      if (is_seen && is_next_seen) {
        ink.add(last, next, ink.half_width(), colour);
      }
      last = next;
      is_seen = is_next_seen;
    }
  }
  ink.dry();
  for (const Vec3& corner : corners(curves)) {
    Spot spot{};
    if (!ink.project(box.to_unit(corner), spot)) continue;
    ink.add(spot, spot, kCornerRadius * ink.half_width(), kCornerColour);
  }
  ink.dry();
}

constexpr int kLargestSide = 8192;
constexpr int kSupersampling = 2;
constexpr std::size_t kMostSurfels = 4'000'000;
constexpr std::size_t kViewpointSurfels = 6'000;

void check(const std::filesystem::path& png, const PointCloud& cloud,
           std::span<const std::uint8_t> classes, const PreviewOptions& options) {
  if (std::min(options.width, options.height) < 1 ||
      std::max(options.width, options.height) > kLargestSide) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: a picture of {} x {} pixels; 1 to {} a side", png.string(),
                            options.width, options.height, kLargestSide));
  }
  if (options.view_direction &&
      !(options.view_direction->allFinite() && options.view_direction->stableNorm() > 0.0)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: the view direction must be finite and not zero", png.string()));
  }
  check_consistent(cloud);
  if (!classes.empty() && classes.size() != cloud.size()) {
    throw Error(ErrorKind::kFailure, fmt::format("{}: {} classes for {} points", png.string(),
                                                 classes.size(), cloud.size()));
  }
}

/// About `count` of the surfels, larger, so that they still cover the surface.
std::vector<Surfel> thinned(const std::vector<Surfel>& surfels, std::size_t count) {
  const std::size_t step = (surfels.size() + count - 1) / count;
  std::vector<Surfel> some;
  for (std::size_t i = 0; i < surfels.size(); i += step) {
    some.push_back(surfels[i]);
    some.back().radius *= std::sqrt(static_cast<float>(step));
  }
  return some;
}

/// The bytes of a PNG file; the same for the same image. Throws Error(kFailure) if libpng refuses.
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

}  // namespace

void write_preview(const std::filesystem::path& png, const PointCloud& cloud,
                   std::span<const std::uint8_t> classes, const PreviewOptions& options,
                   std::span<const lines::Curve> curves) {
  check(png, cloud, classes, options);
  OutputFile file(png, options.overwrite);
  UnitBox box;
  const std::vector<Surfel> surfels =
      make_surfels(cloud, classes, kMostSurfels, &box, options.table);
  if (surfels.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: nothing to draw: the cloud has no finite point", png.string()));
  }
  const Eigen::Vector3f direction =
      options.view_direction
          ? Eigen::Vector3f(options.view_direction->stableNormalized().cast<float>())
          : best_direction(thinned(surfels, kViewpointSurfels));
  const Camera camera =
      frame(surfels, direction, kSupersampling * options.width, kSupersampling * options.height);
  const float area = static_cast<float>(camera.width) * static_cast<float>(camera.height);
  const float min_radius = std::clamp(0.1f * std::sqrt(area / static_cast<float>(surfels.size())),
                                      1.5f, 8.0f * kSupersampling);
  Layer layer = draw(surfels, camera, min_radius);
  close_gaps(layer, static_cast<int>(1.5f * layer.grain_pixels));
  Image image = shade(layer, kSupersampling);
  if (!curves.empty()) draw_curves(image, layer, camera, box, curves);
  file.write(encode_png(image));
  file.commit();
}

}  // namespace pcednet::render
