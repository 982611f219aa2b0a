#pragma once

#include <optional>
#include <vector>

#include "pcednet/lines/piece.h"
#include "pcednet/lines/profile.h"

namespace pcednet::lines {

/// The arcs and circles where a wall ends: at the plane that it rises from, or at both ends of the
/// cone between them. Those at which wall and plane would meet without the cone are appended to
/// `cut_off`.
std::vector<Piece> arcs_of_wall(const Profile& profile, std::vector<Piece>& cut_off);

}  // namespace pcednet::lines
