#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/points/sampling.h"
#include "pcednet/lines/roofs/folds.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {

/// Straight parts and arcs of the outlines of faces away from folds. The foot of a step, above
/// which another face begins, has none. `plan` holds the points of the cloud at height 0.
std::vector<Piece> find_eaves(const OrderedPoints& cloud, const Faces& faces,
                              const Sampling& sampling, const std::vector<Fold>& folds,
                              const spatial::KdTree& plan, const Progress* progress);

/// The place at height 0.
inline Vec3 in_plan(const Vec3& place) {
  return {place.x(), place.y(), 0.0};
}

}  // namespace pcednet::lines
