#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::detect {

// A loose side gate hides the far side of a thin wall, whose normals are opposed, and with it the
// other face of an edge whose faces meet at an acute angle: for the network, either face just ends
// there. Their planes tell both apart. Those of a wall are parallel; those of an edge meet where
// the faces end.

/// A point beside an edge that the gates hide.
struct AcuteEdgePoint {
  std::uint32_t point;
  float distance;  ///< along its face to the edge, in spacings of the 32 nearest others

  friend bool operator==(const AcuteEdgePoint&, const AcuteEdgePoint&) = default;
};

/// The points up to 1.73 spacings from an edge that all gates of the descriptor hide, ascending.
/// There are none if a gate is open; if all are tight, as such a network learns edges as places
/// where a face ends; and if the normals are estimates that turn gradually at an edge.
///
/// The 32 nearest others of such a point are on two faces, with at most a quarter elsewhere: its
/// own, and one of points hidden from it. Both are flat, turned by 14 degrees or more against each
/// other (as planes), come near to the line where they meet, and do not go on past it.
///
/// The result is the same for any number of threads, any order of the points and after a flip of
/// all normals. Throws Error(kCancelled) when `progress` asks to cancel.
std::vector<AcuteEdgePoint> find_acute_edges(const PreparedCloud& cloud,
                                             const gls::ScaleSpaceOptions& descriptor,
                                             const Progress* progress = nullptr);

/// Gives those of the points that `found` calls non-edge the probabilities of edges: sharp-edge up
/// to .6 spacings, smooth-edge up to 1.6 if the model has it.
void mark_acute_edges(std::span<const AcuteEdgePoint> points, const EdgeModel& model,
                      Classification& found);

}  // namespace pcednet::detect
