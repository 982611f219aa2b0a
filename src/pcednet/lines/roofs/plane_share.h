#pragma once

#include "pcednet/lines/roofs/faces.h"

namespace pcednet::lines {

/// The share of the points on plane faces, as opposed to parts of a curved surface: the heights of
/// such a part follow a parabola that turns nearly as much as the adjacent face is turned. A face
/// of a roof may sag. A few faces of too few points to tell are left out.
double plane_share(const OrderedPoints& cloud, const Faces& faces, double spacing);

}  // namespace pcednet::lines
