#pragma once

#include <vector>

#include "pcednet/lines/curve.h"

namespace pcednet::lines {

/// Makes one curve, a polyline mostly, of curves of one class that meet in a corner that no other
/// ends in and turn there by less than `angle` (radians). A segment and an arc that touch
/// stay two, and so do a polyline and a curve of another kind.
/// `tolerance` of the polyline is in the unit of the cloud.
void join_smooth_corners(std::vector<Curve>& curves, double angle, double tolerance);

}  // namespace pcednet::lines
