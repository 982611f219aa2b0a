#pragma once

#include <vector>

#include "pcednet/lines/curves/curve.h"

namespace pcednet::lines {

/// Replaces two or three curves of one class that form a closed loop, meet no others, and lie
/// `within` of a circle by that circle: the edge of a hole or of a boss, broken by noise. Lengths
/// are in the unit of the cloud.
void close_round_loops(std::vector<Curve>& curves, double spacing, double within);

/// Joins curves of one class that meet in a corner where no other ends, and turn there by less than
/// `angle` (radians), into one, usually a polyline. A segment and an arc that touch stay separate,
/// as do a polyline and a curve of another kind. A polyline within the tolerance (in spacings) of a
/// segment is one, before and after; what else is joined is a polyline within half of it.
void join_smooth_corners(std::vector<Curve>& curves, double angle, double tolerance,
                         double spacing);

}  // namespace pcednet::lines
