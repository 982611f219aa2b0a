#include "workbench/report/drawn_lines.h"

#include <cmath>

#include "pcednet/detect/averages.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::report {
namespace {

constexpr double kSteps = 65535.0;          // of the longest side
constexpr double kDrawnTolerance = 0.0002;  // of it: a tenth of a pixel in a panel of 480

}  // namespace

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
