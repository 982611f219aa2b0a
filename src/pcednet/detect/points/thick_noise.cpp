#include "pcednet/detect/points/thick_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/points/near_on_curve.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kSamples = 500;
constexpr std::size_t kFewest = 24, kMost = 3072;  ///< points of a neighbourhood
constexpr std::size_t kAroundEach = 5;             ///< points looked at for each of them
constexpr std::size_t kShareOfCloud = 8;           ///< that a neighbourhood may be, at most

constexpr double kBalls = 0.3;        ///< least relative thickness of the smallest,
constexpr double kFlat = 0.15;        ///< and of a layer
constexpr double kNotThinner = 1.25;  ///< of twice the points, by that of the points
constexpr double kThick = 0.9;        ///< in spacings
constexpr double kEven = 1.7;         ///< third quartile of the noise, by the first
constexpr double kOneLayer = 2.6;     ///< least kurtosis; normal 3, uniform 1.8, two layers 1

/// A neighbourhood's plane of least squares.
struct Layer {
  double thickness = 0.0;  ///< least variance over the middle one
  double deviation = 0.0, spacing = 0.0, kurtosis = 0.0;
};

Layer layer_of(std::span<const Vec3> positions, std::span<const std::uint32_t> points) {
  const auto count = static_cast<double>(points.size());
  const Vec3& origin = positions[points.front()];
  Vec3 sum = Vec3::Zero();
  Mat3 products = Mat3::Zero();
  for (const std::uint32_t i : points) {
    const Vec3 offset = positions[i] - origin;
    sum += offset;
    products += offset * offset.transpose();
  }
  const Vec3 mean = sum / count;
  const auto [variances, axes] = eigendecomposition(products / count - mean * mean.transpose());
  if (!(variances[1] > 0.0)) return {};
  double fourth = 0.0, second = 0.0;
  for (const std::uint32_t i : points) {
    const double height = axes.col(0).dot(positions[i] - origin - mean), square = height * height;
    second += square;
    fourth += square * square;
  }
  const double area = 4.0 * std::numbers::pi * std::sqrt(variances[1] * variances[2]);
  return {.thickness = std::max(variances[0], 0.0) / variances[1],
          .deviation = std::sqrt(second / count),
          .spacing = std::sqrt(area / count),
          .kurtosis = second > 0.0 ? fourth * count / (second * second) : 0.0};
}

std::vector<Layer> layers_of(std::span<const Vec3> positions, std::span<const std::uint32_t> places,
                             std::size_t count) {
  std::vector<Layer> layers(std::min(kSamples, places.size()));
  parallel_blocks(layers.size(), 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const std::size_t place = s * places.size() / layers.size();
      auto points = nearest_on_curve(positions, places, place, kAroundEach * count / 2, count - 1);
      points.push_back(places[place]);
      layers[s] = layer_of(positions, points);
    }
  });
  return layers;
}

/// The value at a share of the layers, in ascending order.
double quantile(const std::vector<Layer>& layers, double Layer::*value, double share) {
  std::vector<double> values;
  for (const Layer& layer : layers) values.push_back(layer.*value);
  return value_at_rank(values,
                       static_cast<std::size_t>(share * static_cast<double>(values.size())));
}

std::optional<ThickNoise> noise_of(const std::vector<Layer>& layers) {
  const double deviation = quantile(layers, &Layer::deviation, 0.25);  // edges have more
  const double spacing = quantile(layers, &Layer::spacing, 0.5);
  const bool is_even = quantile(layers, &Layer::deviation, 0.75) < kEven * deviation;
  const bool is_one_layer = quantile(layers, &Layer::kurtosis, 0.5) > kOneLayer;
  if (deviation < kThick * spacing || !is_even || !is_one_layer) return std::nullopt;
  return ThickNoise{deviation, spacing};
}

}  // namespace

std::string text_of(const ThickNoise& noise) {
  return fmt::format("noise is {:.2g} times the spacing", noise.deviation / noise.spacing);
}

std::optional<ThickNoise> find_thick_noise(std::span<const Vec3> positions,
                                           std::span<const std::uint32_t> curve) {
  const std::vector<std::uint32_t> places = spatial::firsts_of_places(positions, curve);
  double before = kBalls;
  for (std::size_t count = kFewest; count <= kMost && count * kShareOfCloud <= places.size();
       count *= 2) {
    const std::vector<Layer> layers = layers_of(positions, places, count);
    const double thickness = quantile(layers, &Layer::thickness, 0.5);
    if (count == kFewest ? thickness < kBalls : thickness > kNotThinner * before) break;
    if (thickness < kFlat) return noise_of(layers);
    before = thickness;
  }
  return std::nullopt;
}

}  // namespace pcednet::detect
