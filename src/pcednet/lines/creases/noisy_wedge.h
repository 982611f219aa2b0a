#pragma once

#include <cstddef>
#include <optional>

#include "pcednet/lines/points/local_planes.h"

namespace pcednet::lines {

/// The wedge of two half-planes that explain the nearest `count` points, with noise of standard
/// deviation `noise` (in spacings); none if no pair does, or if a smooth surface explains them
/// better.
///
/// find_planes() fits planes to some of the points and needs normals; in noise these are means over
/// an area that reaches across the edge. Here all points count: they are divided along lines of
/// several directions, each part gets its least-squares plane, and the best division is improved by
/// assigning each point to the nearer half-plane.
std::optional<Wedge> fit_half_planes(const NearPoints& points, std::size_t count, double noise);

/// Whether a smooth surface, quadratic around the origin, explains the points well and better than
/// the half-planes of the wedge: they are of a fillet or another rounded surface.
bool is_smooth(const NearPoints& points, const Wedge& wedge, double noise);

}  // namespace pcednet::lines
