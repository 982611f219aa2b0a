#pragma once

#include <vector>

#include "pcednet/lines/curve.h"

namespace pcednet::lines {

/// Makes a circle of two or three curves of one class that meet only each other, one after the
/// other round a loop, and lie `within` of it: the edge of a hole or of a boss, broken by noise.
/// Lengths are in the unit of the cloud.
void close_round_loops(std::vector<Curve>& curves, double spacing, double within);

/// Makes one curve, a polyline mostly, of curves of one class that meet in a corner that no other
/// ends in and turn there by less than `angle` (radians). A segment and an arc that touch
/// stay two, and so do a polyline and a curve of another kind.
/// `tolerance` of the polyline is in the unit of the cloud.
void join_smooth_corners(std::vector<Curve>& curves, double angle, double tolerance);

}  // namespace pcednet::lines
