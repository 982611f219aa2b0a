#pragma once

#include <span>
#include <vector>

#include "pcednet/lines/curves/curve.h"
#include "workbench/shapes/solids/solid_samples.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

/// The sharp edges of `solid` that pass through `borders` or are connected to them, one curve per
/// pair of surfaces and stretch: exact segments, arcs and circles, else polylines within 1e-6.
/// They end where a third face begins, or where the turn falls below kSharpTurn. Curves that end in
/// the same corner share the point.
std::vector<lines::Curve> true_curves(const Solid& solid, std::span<const BorderPoint> borders);

/// The edges of a shape as curves of their class. Those in one line, and chords that turn less than
/// 15 degrees, become one curve if no other edge ends between them. An apex, an edge without
/// length, is none.
std::vector<lines::Curve> true_curves(std::span<const EdgeCurve> edges);

/// The curves rotated about the origin.
std::vector<lines::Curve> rotated(std::vector<lines::Curve> curves, const Mat3& rotation);

/// Drops curves most of whose length is farther than `reach` from the positions.
void drop_unseen(std::vector<lines::Curve>& curves, std::span<const Vec3> positions, double reach);

}  // namespace pcednet::shapes
