#include "workbench/shapes/perturb.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/io/las/file.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::shapes {
namespace {

// Streams of one seed, so that noise and choice of points are independent.
constexpr std::uint64_t kNoise = 1, kChoice = 2;

/// The random numbers that belong to a place.
Random random_at(const Vec3& position, std::uint64_t seed, std::uint64_t purpose) {
  std::uint64_t place = purpose;
  for (int axis = 0; axis < 3; ++axis) {
    // Adding zero makes -0.0, the same place, 0.0.
    place = Random(place, std::bit_cast<std::uint64_t>(position[axis] + 0.0)).next();
  }
  return Random(seed, place);
}

Vec3 rounded_to(ScalarType type, const Vec3& position) {
  if (type != ScalarType::kFloat32) return position;
  Vec3 rounded;
  for (int axis = 0; axis < 3; ++axis) {
    // Unless volatile, g++ 12 takes two neighbouring conversions to float and back for none.
    const volatile float narrow = static_cast<float>(position[axis]);
    rounded[axis] = narrow;
  }
  return rounded;
}

template <typename T>
std::vector<T> chosen(const std::vector<T>& all, std::span<const std::uint32_t> points) {
  std::vector<T> kept;
  if (all.empty()) return kept;
  kept.reserve(points.size());
  for (const std::uint32_t point : points) kept.push_back(all[point]);
  return kept;
}

Attribute chosen(const Attribute& all, std::span<const std::uint32_t> points) {
  Attribute kept = {all.name, all.type, all.components, {}};
  kept.bytes.reserve(points.size() * all.stride());
  for (const std::uint32_t point : points) {
    const auto first = all.bytes.begin() + static_cast<std::ptrdiff_t>(point * all.stride());
    kept.bytes.insert(kept.bytes.end(), first, first + static_cast<std::ptrdiff_t>(all.stride()));
  }
  return kept;
}

/// All points in random order; those at one place keep theirs.
std::vector<std::uint32_t> by_lot(const PointCloud& cloud, std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> lots(cloud.size());
  for (std::uint32_t i = 0; i < lots.size(); ++i) {
    lots[i] = {random_at(cloud.positions[i], seed, kChoice).next(), i};
  }
  std::sort(lots.begin(), lots.end());
  std::vector<std::uint32_t> points(lots.size());
  std::transform(lots.begin(), lots.end(), points.begin(), [](auto lot) { return lot.second; });
  return points;
}

}  // namespace

PointCloud select(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  PointCloud kept;
  kept.scanners = cloud.scanners;
  kept.positions = chosen(cloud.positions, points);
  kept.normals = chosen(cloud.normals, points);
  for (const Attribute& axis : cloud.stored_normals) {
    kept.stored_normals.push_back(chosen(axis, points));
  }
  kept.colours = chosen(cloud.colours, points);
  kept.labels = chosen(cloud.labels, points);
  for (const Attribute& attribute : cloud.attributes) {
    kept.attributes.push_back(chosen(attribute, points));
  }
  std::copy_if(cloud.foreign_elements.begin(), cloud.foreign_elements.end(),
               std::back_inserter(kept.foreign_elements), io::is_las_element);
  kept.position_type = cloud.position_type;
  kept.comments = cloud.comments;
  return kept;
}

PointCloud add_gaussian_noise(PointCloud cloud, const NoiseOptions& options) {
  if (!(options.sigma >= 0.0) || !std::isfinite(options.sigma)) {
    throw Error(ErrorKind::kUsage, fmt::format("noise of {}: expected 0 or more", options.sigma));
  }
  if (options.along_normal && !cloud.has_normals() && !cloud.empty()) {
    throw Error(ErrorKind::kInsufficient, "noise along the normals, and there are no normals");
  }
  check_extent(cloud.positions);
  const double sigma = options.sigma * bounding_box(cloud.positions).diagonal();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Vec3& position = cloud.positions[i];
    Random random = random_at(position, options.seed, kNoise);
    const double first = random.normal(), second = random.normal(), third = random.normal();
    const Vec3 move =
        options.along_normal ? Vec3(first * cloud.normals[i]) : Vec3(first, second, third);
    if (position.allFinite() && move.allFinite()) {
      position = rounded_to(cloud.position_type, position + sigma * move);
    }
  }
  cloud.comments.push_back(fmt::format("Gaussian noise {}: sigma {} of the diagonal, seed {}",
                                       options.along_normal ? "along the normal" : "on each axis",
                                       options.sigma, options.seed));
  return cloud;
}

PointCloud subsample(const PointCloud& cloud, const SubsampleOptions& options) {
  if (!(options.fraction >= 0.0 && options.fraction <= 1.0)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("a fraction of {} of the points: expected 0 ... 1", options.fraction));
  }
  std::vector<std::uint32_t> points = by_lot(cloud, options.seed);
  points.resize(
      static_cast<std::size_t>(std::llround(options.fraction * static_cast<double>(cloud.size()))));
  std::sort(points.begin(), points.end());
  PointCloud kept = select(cloud, points);
  kept.comments.push_back(
      fmt::format("subsample: {} of the points, seed {}", options.fraction, options.seed));
  return kept;
}

PointCloud thin(const PointCloud& cloud, const ThinOptions& options, const Progress* progress) {
  if (!(options.spacing > 0.0) || !std::isfinite(options.spacing)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("a spacing of {}: expected more than 0", options.spacing));
  }
  check_extent(cloud.positions);
  const spatial::KdTree tree(cloud.positions);
  std::vector<std::uint32_t> points;
  std::vector<std::uint8_t> dropped(cloud.size(), 0);
  std::vector<spatial::Neighbour> near;
  Stage stage(progress, "thin", cloud.size());
  for (const std::uint32_t point : by_lot(cloud, options.seed)) {
    stage.advance(1);
    if (dropped[point] || !cloud.positions[point].allFinite()) continue;
    points.push_back(point);
    tree.within_unsorted(cloud.positions[point], options.spacing, near);
    for (const spatial::Neighbour& other : near) dropped[other.index] = 1;
  }
  std::sort(points.begin(), points.end());
  PointCloud kept = select(cloud, points);
  kept.comments.push_back(
      fmt::format("thinned: points at least {} apart, seed {}", options.spacing, options.seed));
  return kept;
}

}  // namespace pcednet::shapes
