#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "workbench/shapes/shape.h"

namespace pcednet::shapes {

/// The width of the band along the rims that is labelled boundary, in spacings.
inline constexpr double kBoundaryBand = 0.7;

/// Adds to `shape` the borders of its patches over the unit square, in short chords, except those
/// on one of its edges. Not for patches that are trimmed, closed or joined without an edge.
void add_rims(Shape& shape);

/// Labels non-edge points nearer than `width` to a rim kBoundary.
void label_rims(std::span<const Vec3> positions, std::span<const Segment> rims, double width,
                std::span<std::uint8_t> labels);

}  // namespace pcednet::shapes
