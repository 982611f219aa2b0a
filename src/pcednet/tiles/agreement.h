#pragma once

#include <optional>
#include <vector>

#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// Throws Error(kUsage), naming two inputs and the difference, unless all can be one cloud: with
/// the same columns (but for `scan`, where choose_scanners() numbers the scans, and for fields of
/// LAS, of which the tiles have all), coordinate system as far as it is named, and without
/// waveforms if there are several. Chooses the plan's forms, and leaves out of inputs the extra
/// bytes and GPS times that mean something else than those of the first. Notes all this, and what
/// the tiles cannot keep: faces, records of LAS that the first input lacks.
void check_agreement(std::vector<IndexedInput>& inputs, Plan& plan);

/// The plan's scanners: the one at `viewpoint`, otherwise those of all inputs if these agree, or
/// those of input after input, which get their places in the list. Throws Error(kUsage) where
/// `viewpoint` is given and an input is of several scans.
void choose_scanners(std::vector<IndexedInput>& inputs, const std::optional<Vec3>& viewpoint,
                     Plan& plan);

}  // namespace pcednet::tiles
