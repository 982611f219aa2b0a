#pragma once

#include <optional>
#include <vector>

#include "pcednet/lines/faces.h"
#include "pcednet/lines/piece.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {

/// A segment in which the planes of two faces meet.
struct Fold {
  Piece piece;  ///< side a of its nodes is in `face`, side b in `other`
  std::uint32_t face, other;
};

/// The intersections of the planes of faces whose points are adjacent there.
std::vector<Fold> find_roof_folds(const OrderedPoints& cloud, const Faces& faces, double spacing);

/// Straight parts and arcs of the outlines of faces away from folds. The foot of a step, above
/// which another face begins, has none. `plan` holds the points of the cloud at height 0.
std::vector<Piece> find_eaves(const OrderedPoints& cloud, const Faces& faces,
                              const Sampling& sampling, const std::vector<Fold>& folds,
                              const spatial::KdTree& plan);

/// The folds and eaves of a roof: a surface seen from above (z is up), nowhere above itself, with
/// nine in ten points on plane faces. None for other clouds.
std::optional<std::vector<Piece>> find_plane_edges(const OrderedPoints& cloud,
                                                   const Sampling& sampling,
                                                   const Progress* progress);

/// The place at height 0.
inline Vec3 in_plan(const Vec3& place) {
  return {place.x(), place.y(), 0.0};
}

}  // namespace pcednet::lines
