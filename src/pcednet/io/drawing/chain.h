#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "pcednet/lines/curves/curve.h"

namespace pcednet::io {

/// Whether squared distances do not overflow.
inline bool is_drawable(const Vec3& point) {
  return (point.array().abs() <= 1e150).all();
}

/// A polyline along `chain`, indices into `vertices`; closed if it ends where it began. Has fewer
/// than two points if all vertices are at one place.
inline lines::Curve curve_along(std::span<const std::size_t> chain,
                                std::span<const Vec3> vertices) {
  lines::Curve curve;
  for (const std::size_t vertex : chain) {
    const Vec3& point = vertices[vertex];
    if (curve.points.empty() || curve.points.back() != point) curve.points.push_back(point);
  }
  curve.closed = curve.points.size() > 3 && curve.points.front() == curve.points.back();
  if (curve.closed) curve.points.pop_back();
  return curve;
}

}  // namespace pcednet::io
