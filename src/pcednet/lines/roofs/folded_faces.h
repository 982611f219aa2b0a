#pragma once

#include "pcednet/lines/roofs/faces.h"

namespace pcednet::lines {

/// Divides faces that two or three planes, which meet in parallel folds, explain better than one
/// plane, and better than a parabola: within the noise of few points, slopes that differ little
/// grow into one face. Tells of the others whether the parabola explains them better. Returns
/// whether any was divided.
bool divide_folded(const OrderedPoints& cloud, double spacing, Faces& faces);

/// Moves the border of faces that meet at a low angle to the fold in which their planes meet, where
/// that explains their points as well. Returns whether any point moved.
bool straighten_folds(const OrderedPoints& cloud, double spacing, Faces& faces);

}  // namespace pcednet::lines
