#pragma once

#include <optional>
#include <vector>

#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// Throws Error(kUsage), naming two inputs and the difference, unless all can be one cloud: with
/// the same columns (but for `scan`, where choose_scanners() numbers the scans), meaning of extra
/// bytes, coordinate system and count of GPS time, and without waveforms if there are several.
/// Notes what the tiles cannot keep: faces, records of LAS that the first input lacks.
void check_agreement(const std::vector<IndexedInput>& inputs, Plan& plan);

/// The plan's scanners: the one at `viewpoint`, otherwise those that all inputs tell alike, or
/// those of input after input, which get their places in the list. Throws Error(kUsage) where
/// `viewpoint` is given and an input is of several scans.
void choose_scanners(std::vector<IndexedInput>& inputs, const std::optional<Vec3>& viewpoint,
                     Plan& plan);

}  // namespace pcednet::tiles
