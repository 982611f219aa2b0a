#pragma once

#include <vector>

#include "pcednet/lines/pieces/corners.h"
#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// Turns segments that are nearly parallel to a longer one, or nearly orthogonal to one or two,
/// exactly so, and marks these and the longer ones as regular.
void regularise(std::vector<Piece>& pieces);

/// Moves corners, and the free ends of regular segments, so that regular segments have their
/// direction between the corners that they end in: by least squares, each connected group of
/// corners for itself. Segments whose directions contradict those of others, so that corners would
/// move by more than two spacings, turn.
void hold_directions(std::vector<Piece>& pieces, Corners& corners);

}  // namespace pcednet::lines
