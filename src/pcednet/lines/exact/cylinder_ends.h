#pragma once

#include "pcednet/lines/exact/pieces.h"
#include "pcednet/lines/exact/profile.h"

namespace pcednet::lines {

/// The arcs and circles where a cylinder ends: at the plane that it rises from, or at both ends of
/// the cone between them. Those at which cylinder and plane would meet without the cone are cut
/// off.
ExactEdges edges_of_cylinder(const Profile& profile);

}  // namespace pcednet::lines
