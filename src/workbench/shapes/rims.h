#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "workbench/shapes/shape.h"

namespace pcednet::shapes {

/// The width of the band along the rims that is labelled boundary, in spacings.
inline constexpr double kBoundaryBand = 0.7;

/// Adds to `shape` the borders of its patches over the unit square, in short chords, but for those
/// that lie on one of its edges. Patches that are trimmed, closed or joined without an edge are not
/// for it.
void add_rims(Shape& shape);

/// Labels kBoundary what is non-edge and nearer than `width` to a rim.
void label_rims(std::span<const Vec3> positions, std::span<const Segment> rims, double width,
                std::span<std::uint8_t> labels);

}  // namespace pcednet::shapes
