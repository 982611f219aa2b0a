#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/exact/contacts.h"
#include "pcednet/lines/exact/cylinders.h"
#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// The segments along the axes of cylinders, where they meet planes and each other: as of a slot
/// with a round bottom, or of a profile of lines and arcs. `free_points` are the contacts of each
/// plane with points of none, among which the cylinders were found.
std::vector<Piece> find_cylinder_folds(
    const OrderedPoints& cloud, const std::vector<PlanePatch>& planes,
    const std::vector<ExactCylinder>& cylinders,
    const std::vector<std::span<const PlaneContact>>& free_points, double spacing,
    const Progress* progress);

}  // namespace pcednet::lines
