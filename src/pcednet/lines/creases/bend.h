#pragma once

#include "pcednet/lines/points/local_planes.h"

namespace pcednet::lines {

/// How much the points of a wedge bend into it, near its line and far from that, in spacings: their
/// mean distance to its planes, less that of the points between. The mean of both sides; points
/// farther than `tolerance` and a bit from the planes do not count.
double bend_of(const Wedge& wedge, const NearPoints& points, double tolerance);

}  // namespace pcednet::lines
