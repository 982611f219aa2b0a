#pragma once

#include "pcednet/lines/faces.h"

namespace pcednet::lines {

/// The share of the points that are of plane faces, not of parts of a curved surface: the heights
/// of a part of one follow a parabola that turns nearly as much as the face beside it is turned. A
/// face of a roof may sag.
double plane_share(const OrderedPoints& cloud, const Faces& faces, double spacing);

}  // namespace pcednet::lines
