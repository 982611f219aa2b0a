#include "workbench/render/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pcednet/core/error.h"
#include "workbench/render/camera.h"
#include "workbench/render/draw_curves.h"
#include "workbench/render/gaps.h"
#include "workbench/render/png.h"
#include "workbench/render/shade.h"
#include "workbench/render/splat.h"
#include "workbench/render/surfels.h"

namespace pcednet::render {
namespace {

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
