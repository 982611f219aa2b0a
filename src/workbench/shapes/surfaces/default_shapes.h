#pragma once

#include "pcednet/core/random.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

// The shapes of the Default training set other than regular solids; lengths are about 1.

/// A cone standing on a round plate: curved edges, convex and concave, and an apex.
Shape cone_on_plate();

/// A sector of a revolved part, after the fan disk of the CAD literature: curved sharp edges of
/// many angles, a chamfer and a bead that fade out along the sector.
Shape fan_part();

/// Four unit cubes joined at parts of their faces, so that convex and concave edges meet.
Shape four_cubes();

// Beyond the paper's set.

/// Three to five boxes added to or cut out of each other at random, on a grid of 1/8.
Shape random_blocks(Random& random);

/// Pairs of open rectangles meeting at 60 to 150 degrees, every other one inside out.
Shape wedges();

/// Open sheets, flat and bent, without any edge.
Shape open_sheets();

/// Open sheets with a straight and a ring-shaped crease, up and down, that fade out.
Shape fading_creases();

/// A box whose edges are rounded with `radius`: smooth edges only.
Shape rounded_box(double radius);

/// A cylinder and a ball.
Shape round_solids();

/// The front of a wall with recessed windows, sills, a door, a cornice and steps: an open sheet of
/// plane pieces, as seen by a scanner in the street.
Shape wall_front(Random& random);

}  // namespace pcednet::shapes
