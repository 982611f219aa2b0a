#include "workbench/report/scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/octahedral.h"
#include "pcednet/core/error.h"
#include "pcednet/core/random.h"
#include "pcednet/detect/averages.h"
#include "pcednet/lines/find_lines.h"
#include "pcednet/normals/estimate.h"
#include "workbench/render/camera.h"
#include "workbench/render/surfels.h"

namespace pcednet::report {
namespace {

constexpr std::size_t kViewpointSurfels = 6'000;

std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = Random(hash ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0)).next();  // -0 equals 0
  }
  return hash;
}

std::vector<std::size_t> choose(std::span<const Vec3> positions, std::size_t count) {
  std::vector<std::pair<std::uint64_t, std::size_t>> hashed;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i].allFinite()) hashed.emplace_back(hash_of(positions[i]), i);
  }
  std::sort(hashed.begin(), hashed.end());
  hashed.resize(std::min(hashed.size(), count));
  std::vector<std::size_t> shown;
  for (const auto& [hash, i] : hashed) shown.push_back(i);
  return shown;
}

void append_uint16(std::vector<std::uint8_t>& bytes, double unit) {
  const auto number = static_cast<std::uint32_t>(std::lround(std::clamp(unit, 0.0, 1.0) * 65535.0));
  bytes.push_back(static_cast<std::uint8_t>(number & 255));
  bytes.push_back(static_cast<std::uint8_t>(number >> 8));
}

void put_positions(Scene& scene, std::span<const Vec3> positions) {
  std::vector<Vec3> chosen;
  for (const std::size_t i : scene.shown) chosen.push_back(positions[i]);
  const BoundingBox box = bounding_box(chosen);
  scene.size = (box.max - box.min).maxCoeff();
  for (int axis = 0; axis < 3; ++axis) scene.min[axis] = box.min[axis];
  const double scale = scene.size > 0 ? 1 / scene.size : 0;
  std::vector<std::uint8_t> bytes;
  for (const Vec3& p : chosen) {
    for (int axis = 0; axis < 3; ++axis) append_uint16(bytes, (p[axis] - box.min[axis]) * scale);
  }
  scene.positions = encode_base64(bytes);
}

void put_normals(Scene& scene, std::span<const Vec3> normals) {
  std::vector<std::uint8_t> bytes;
  for (const std::size_t i : scene.shown) {
    for (const double u : octahedral(normals[i])) {
      bytes.push_back(static_cast<std::uint8_t>(std::lround((u + 1) / 2 * 255)));
    }
  }
  scene.normals = encode_base64(bytes);
}

void put_view(Scene& scene, const PointCloud& cloud) {
  const auto surfels = render::make_surfels(cloud, cloud.labels, kViewpointSurfels);
  if (surfels.empty()) return;
  const Eigen::Vector3f direction = render::best_direction(surfels);
  for (int axis = 0; axis < 3; ++axis) scene.view[axis] = direction[axis];
}

constexpr double kSteps = 65535.0;          // of the longest side
constexpr double kDrawnTolerance = 0.0002;  // of it: a tenth of a pixel in a panel of 480

}  // namespace

std::string encode_base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= left ? kDigits[group >> (18 - 6 * digit) & 63] : '=';
    }
  }
  return text;
}

Scene make_scene(const PointCloud& cloud, std::size_t count, const Progress* progress) {
  Scene scene;
  scene.shown = choose(cloud.positions, count);
  if (scene.shown.empty()) {
    throw Error(ErrorKind::kInsufficient, "nothing to show: the cloud has no finite point");
  }
  put_positions(scene, cloud.positions);
  const Progress quiet = without_report(progress);
  put_normals(scene, cloud.has_normals() ? cloud.normals
                                         : normals::estimate_normals(cloud.positions, {}, &quiet));
  put_view(scene, cloud);
  return scene;
}

std::string pack_classes(std::span<const std::uint8_t> classes,
                         std::span<const std::size_t> shown) {
  std::vector<std::uint8_t> bytes((shown.size() + 1) / 2);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const unsigned code = std::min<unsigned>(classes[shown[k]], kBoundary + 1u);
    bytes[k / 2] |= static_cast<std::uint8_t>(code << 4 * (k % 2));
  }
  return encode_base64(bytes);
}

OrderedJson find_drawn_lines(const detect::PreparedCloud& cloud,
                             std::span<const std::uint8_t> classes, const Scene& scene,
                             const Progress* progress) {
  auto drawn = OrderedJson::array();
  if (!(scene.size > 0.0)) return drawn;
  detect::Classification found;
  found.classes.assign(classes.begin(), classes.end());
  found = of_averages(cloud, std::move(found));
  const auto curves = lines::find_lines({.positions = cloud.positions,
                                         .normals = cloud.normals,
                                         .classes = found.classes,
                                         .curve = cloud.curve},
                                        {}, progress);
  for (const lines::Curve& curve : curves) {
    auto path = OrderedJson::array();
    for (const Vec3& vertex : lines::sampled(curve, kDrawnTolerance * scene.size)) {
      for (int axis = 0; axis < 3; ++axis) {
        path.push_back(std::lround((vertex[axis] - scene.min[axis]) / scene.size * kSteps));
      }
    }
    drawn.push_back({{"class", curve.edge_class},
                     {"length", lines::length_of(curve)},
                     {"path", std::move(path)}});
  }
  return drawn;
}

}  // namespace pcednet::report
