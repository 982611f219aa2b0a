#pragma once

#include <vector>

#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// Throws Error(kUsage), naming two inputs and the difference, unless all can be one cloud: with
/// the same columns, meaning of extra bytes, coordinate system and count of GPS time, and without
/// waveforms if there are several. Notes what the tiles cannot keep: scanners, faces, records of
/// LAS that the first input lacks.
void check_agreement(const std::vector<IndexedInput>& inputs, Plan& plan);

}  // namespace pcednet::tiles
