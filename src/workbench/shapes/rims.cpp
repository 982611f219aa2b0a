#include "workbench/shapes/rims.h"

#include <algorithm>
#include <array>

#include "pcednet/core/parallel.h"

namespace pcednet::shapes {
namespace {

constexpr int kChords = 96;  // of each side of a patch
constexpr double kOnEdge = 1e-9;

bool is_on_edge(const Shape& shape, const Vec3& point) {
  return std::any_of(shape.edges.begin(), shape.edges.end(), [&](const EdgeCurve& edge) {
    return std::visit([&](const auto& curve) { return distance(curve, point); }, edge.curve) <
           kOnEdge;
  });
}

}  // namespace

void add_rims(Shape& shape) {
  const std::array<std::array<double, 2>, 5> corners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  for (const SurfacePatch& patch : shape.patches) {
    for (std::size_t side = 0; side < 4; ++side) {
      const auto at = [&](int i) {
        const double t = static_cast<double>(i) / kChords;
        const auto& a = corners[side];
        const auto& b = corners[side + 1];
        return patch.at(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])).position;
      };
      for (int i = 0; i < kChords; ++i) {
        const Segment chord = {at(i), at(i + 1)};
        if (!is_on_edge(shape, 0.5 * (chord.a + chord.b))) shape.rims.push_back(chord);
      }
    }
  }
}

void label_rims(std::span<const Vec3> positions, std::span<const Segment> rims, double width,
                std::span<std::uint8_t> labels) {
  parallel_blocks(positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (labels[i] != kNonEdge) continue;
      const bool near = std::any_of(rims.begin(), rims.end(), [&](const Segment& rim) {
        return distance(rim, positions[i]) < width;
      });
      if (near) labels[i] = kBoundary;
    }
  });
}

}  // namespace pcednet::shapes
